// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/numeric/interpolation.h>
#include <petzval/numeric/random.h>
#include <petzval/numeric/random_lanes.h>
#include <petzval/sensor/blooming.h>
#include <petzval/sensor/capture.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

// What random numbers are for; temporal ones carry the frame in the upper bits.
enum Purpose : std::uint32_t {
  pixel_pattern = 1,
  column_offsets = 2,
  hot_pixels = 3,
  dead_pixels = 4,
  shot_noise = 5,
  read_noise = 6,
  row_offsets = 7
};
constexpr int frame_shift = 8;
constexpr int max_frames = 1 << 16, last_frame = 1 << 24;

constexpr int further_reading = 8;  // added to a purpose for each
constexpr int most_readings = 16;

std::uint32_t of_frame(Purpose purpose, int frame, int reading = 0) {
  return static_cast<std::uint32_t>(purpose + further_reading * reading) | static_cast<std::uint32_t>(frame)
                                                                               << frame_shift;
}

struct Defect {
  std::uint64_t place;  ///< row × columns of the sensor + column
  bool hot;
  bool operator<(const Defect& other) const { return place < other.place; }
};

/// Where the sensor's defects are: a Poisson number of places, drawn with replacement.
std::vector<Defect> defects_of(const Sensor& sensor, std::uint64_t serial) {
  const SensorElectronics& electronics = *sensor.electronics;
  const auto pixels =
      static_cast<double>(sensor.geometry.columns) * static_cast<double>(sensor.geometry.rows);
  std::vector<Defect> defects;
  const auto draw = [&](Purpose purpose, double per_million, bool hot) {
    RandomStream random(serial, purpose, 0);
    const double count = random.poisson(pixels * per_million * 1e-6);
    for (double i = 0; i < count; ++i)
      defects.push_back({static_cast<std::uint64_t>(random.uniform() * pixels), hot});
  };
  draw(hot_pixels, electronics.hot_pixels_per_million, true);
  draw(dead_pixels, electronics.dead_pixels_per_million, false);
  std::stable_sort(defects.begin(), defects.end());
  return defects;
}

/// Signal → signal as the converter sees it, both in electrons.
class Linearity {
 public:
  Linearity(const SensorElectronics& electronics, double full_well_e)
      : fractions_(electronics.linearity_fractions),
        deviations_(electronics.linearity_deviations),
        scale_(full_well_e) {}
  bool is_exact() const { return fractions_.empty(); }
  double operator()(double signal_e) const {
    if (signal_e <= 0) return signal_e;
    return signal_e * (1 + deviation(signal_e / scale_));
  }
  /// The signal that comes out as this: the curve rises, and between two points of it is a parabola.
  double inverse(double out_e) const {
    if (out_e <= 0) return out_e;
    const auto at = [&](std::size_t i) { return scale_ * fractions_[i] * (1 + deviations_[i]); };
    if (fractions_.size() == 1 || out_e <= at(0)) return out_e / (1 + deviations_.front());
    if (out_e >= at(fractions_.size() - 1)) return out_e / (1 + deviations_.back());
    std::size_t i = 0;
    while (at(i + 1) < out_e) ++i;
    const double slope = (deviations_[i + 1] - deviations_[i]) / (fractions_[i + 1] - fractions_[i]);
    const double linear = 1 + deviations_[i] - slope * fractions_[i];
    return 2 * out_e / (linear + std::sqrt(linear * linear + 4 * slope / scale_ * out_e));
  }

 private:
  double deviation(double fraction) const {
    if (fractions_.size() == 1 || fraction <= fractions_.front()) return deviations_.front();
    if (fraction >= fractions_.back()) return deviations_.back();
    const std::size_t i = bracket(fractions_, fraction);
    return deviations_[i] + (deviations_[i + 1] - deviations_[i]) * (fraction - fractions_[i]) /
                                (fractions_[i + 1] - fractions_[i]);
  }
  std::vector<double> fractions_, deviations_;
  double scale_;
};

/// One exposure's worth of numbers, settled before the pixels are walked.
class Exposure {
 public:
  Exposure(const PhotoCurrent& current, const Sensor& sensor, double exposure_s,
           const CaptureOptions& options)
      : current_(current),
        sensor_(sensor),
        electronics_(*sensor.electronics),
        options_(options),
        mode_(electronics_.gain_mode(options.gain_mode)),
        linearity_(options.has(NoiseSource::linearity) ? electronics_ : SensorElectronics{},
                   mode_.full_well_e),
        serial_(options.serial.value_or(electronics_.serial)),
        exposure_s_(exposure_s),
        dn_per_e_(mode_.dn_per_e * options.analog_gain) {
    const double temperature = options.temperature_c.value_or(electronics_.dark_temperature_c);
    if (options.has(NoiseSource::dark)) dark_e_ = electronics_.dark_current_at(temperature) * exposure_s;
    hot_e_ = electronics_.hot_current_e_per_s *
             std::exp2((temperature - electronics_.dark_temperature_c) / electronics_.dark_doubling_c) *
             exposure_s;
    if (options.has(NoiseSource::read))
      read_e_ = std::hypot(mode_.read_noise_e, mode_.adc_noise_dn / dn_per_e_);
    if (options.has(NoiseSource::prnu)) prnu_ = electronics_.prnu;
    if (options.has(NoiseSource::dsnu)) dsnu_e_ = electronics_.dsnu_e;
    if (options.has(NoiseSource::defects)) defects_ = defects_of(sensor, serial_);
    column_offsets_e_.resize(static_cast<std::size_t>(current.columns));
    if (options.has(NoiseSource::column) && electronics_.column_pattern_e > 0)
      for (std::size_t c = 0; c < column_offsets_e_.size(); ++c)
        column_offsets_e_[c] =
            electronics_.column_pattern_e * RandomStream(serial_, Purpose::column_offsets,
                                                         c + static_cast<std::uint64_t>(current.first_column))
                                                .normal();
  }

  double dn_per_e() const { return dn_per_e_; }
  /// Those of the sensor that lie in the frame.
  std::vector<PixelPlace> bad_pixels() const {
    std::vector<PixelPlace> places;
    const auto columns = static_cast<std::uint64_t>(sensor_.geometry.columns);
    for (const Defect& defect : defects_) {
      const PixelPlace place{static_cast<int>(defect.place / columns) - current_.first_row,
                             static_cast<int>(defect.place % columns) - current_.first_column};
      const bool inside =
          place.row >= 0 && place.column >= 0 && place.row < current_.rows && place.column < current_.columns;
      if (inside && (places.empty() || !(places.back() == place))) places.push_back(place);
    }
    return places;
  }
  double read_noise_e() const { return std::sqrt(read_e_ * read_e_ + 1 / (12 * dn_per_e_ * dn_per_e_)); }
  const Linearity& linearity() const { return linearity_; }
  /// As the converter sees it.
  double saturation_e() const {
    return std::min(linearity_.is_exact() ? mode_.full_well_e : linearity_(mode_.full_well_e),
                    (electronics_.white_level_dn - electronics_.black_level_dn) / dn_per_e_);
  }

  bool blooms() const { return options_.has(NoiseSource::blooming) && electronics_.blooming_onset > 0; }

  /// The electrons of a frame, [column][row], when they have flowed along their columns.
  std::vector<double> bloomed(int frame) const {
    const auto columns = static_cast<std::size_t>(current_.columns),
               rows = static_cast<std::size_t>(current_.rows);
    std::vector<double> electrons(columns * rows);
    parallel_for(rows, [&](std::size_t row) {
      std::vector<double> of_row(columns), offsets(columns), random(columns);
      collect_row(static_cast<int>(row), frame, of_row, offsets, random);
      for (std::size_t c = 0; c < columns; ++c) electrons[c * rows + row] = of_row[c];
    });
    parallel_for(columns, [&](std::size_t column) {
      bloom_column({electrons.data() + column * rows, rows}, electronics_.blooming_onset * mode_.full_well_e);
    });
    return electrons;
  }

  /// Adds the numbers of one row of one frame to `sums`. \param bloomed  what bloomed() says of this frame,
  /// or nothing.
  void expose_row(int row, int frame, std::span<const double> bloomed, std::span<std::uint32_t> sums) const {
    const std::uint64_t first = place_of(row);
    const bool rows_move = options_.has(NoiseSource::row) && electronics_.row_noise_e > 0;
    const double row_e = rows_move
                             ? electronics_.row_noise_e *
                                   RandomStream(options_.seed, of_frame(row_offsets, frame, options_.reading),
                                                static_cast<std::uint64_t>(row + current_.first_row))
                                       .normal()
                             : 0;
    const std::size_t columns = sums.size();
    std::vector<double> electrons(columns), offsets(column_offsets_e_), random(columns);
    for (double& offset : offsets) offset += row_e;
    collect_row(row, frame, electrons, offsets, random);
    if (!bloomed.empty())
      for (std::size_t c = 0; c < columns; ++c)
        electrons[c] = bloomed[c * static_cast<std::size_t>(current_.rows) + static_cast<std::size_t>(row)];
    if (read_e_ > 0) {
      uniform_numbers(options_.seed, of_frame(read_noise, frame, options_.reading), first, random, {});
      to_normal(random);
    }
    for (std::size_t c = 0; c < columns; ++c) {
      double signal_e = std::min(electrons[c], mode_.full_well_e) + offsets[c];
      if (!linearity_.is_exact()) signal_e = linearity_(signal_e);
      if (read_e_ > 0) signal_e += read_e_ * random[c];
      const double dn = std::floor(electronics_.black_level_dn + dn_per_e_ * signal_e + 0.5);
      sums[c] += static_cast<std::uint32_t>(std::clamp(dn, 0.0, electronics_.white_level_dn));
    }
  }

 private:
  /// The electrons of a row, and what its pixels add to `offsets`.
  void collect_row(int row, int frame, std::span<double> electrons, std::span<double> offsets,
                   std::span<double> random) const {
    const std::uint64_t first = place_of(row);
    const float* rates =
        current_.e_per_s.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(current_.columns);
    for (std::size_t c = 0; c < electrons.size(); ++c)
      electrons[c] = static_cast<double>(rates[c]) * exposure_s_;
    if (prnu_ > 0 || dsnu_e_ > 0) add_pixel_patterns(first, electrons, offsets, random);
    for (double& e : electrons) e += dark_e_;
    add_defects(first, electrons);
    if (options_.has(NoiseSource::shot))
      poisson_numbers(options_.seed, of_frame(shot_noise, frame), first, electrons, electrons);
  }

  std::uint64_t place_of(int row) const {
    return static_cast<std::uint64_t>(row + current_.first_row) *
               static_cast<std::uint64_t>(sensor_.geometry.columns) +
           static_cast<std::uint64_t>(current_.first_column);
  }

  /// The two deviates of each pixel's stream: of its gain and of its offset.
  void add_pixel_patterns(std::uint64_t first, std::span<double> light_e, std::span<double> offsets_e,
                          std::span<double> random) const {
    std::vector<double> second(light_e.size());
    uniform_numbers(serial_, pixel_pattern, first, random, second);
    to_normal(random);
    to_normal(second);
    for (std::size_t c = 0; c < light_e.size(); ++c) {
      light_e[c] *= std::max(0.0, 1 + prnu_ * random[c]);
      offsets_e[c] += dsnu_e_ * second[c];
    }
  }

  void add_defects(std::uint64_t first, std::span<double> electrons) const {
    for (auto defect = std::lower_bound(defects_.begin(), defects_.end(), Defect{first, false});
         defect != defects_.end() && defect->place < first + electrons.size(); ++defect) {
      double& e = electrons[defect->place - first];
      e = defect->hot ? e + hot_e_ : 0;
    }
  }

  const PhotoCurrent& current_;
  const Sensor& sensor_;
  const SensorElectronics& electronics_;
  const CaptureOptions& options_;
  const GainMode& mode_;
  Linearity linearity_;
  std::uint64_t serial_;
  double exposure_s_, dn_per_e_;
  double dark_e_ = 0, hot_e_ = 0, read_e_ = 0, prnu_ = 0, dsnu_e_ = 0;
  std::vector<Defect> defects_;
  std::vector<double> column_offsets_e_;
};

void check(const SensorElectronics& electronics, double exposure_s, const CaptureOptions& options) {
  const GainMode& mode = electronics.gain_mode(options.gain_mode);
  if (!(options.analog_gain >= 1 && options.analog_gain <= mode.max_analog_gain))
    throw InputError(fmt::format("an analog gain of {:g}; 1 to {:g} would be right", options.analog_gain,
                                 mode.max_analog_gain));
  constexpr double longest_s = 1e6;
  if (!(exposure_s >= 0 && exposure_s <= longest_s))
    throw InputError(fmt::format("an exposure of {:g} s; 0 to {:g} would be right", exposure_s, longest_s));
  if (options.frames < 1 || options.frames > max_frames)
    throw InputError(fmt::format("{} frames; 1 to {} would be right", options.frames, max_frames));
  if (options.first_frame < 0 || options.first_frame > last_frame - options.frames)
    throw InputError(fmt::format("frame {} of a clip; 0 to {} would be right", options.first_frame,
                                 last_frame - options.frames));
  if (options.reading < 0 || options.reading >= most_readings)
    throw InputError(
        fmt::format("reading {} of an exposure; 0 to {} would be right", options.reading, most_readings - 1));
  constexpr double coldest_c = -273.15, hottest_c = 300;
  if (options.temperature_c && !(*options.temperature_c >= coldest_c && *options.temperature_c <= hottest_c))
    throw InputError(fmt::format("a temperature of {:g} degrees; {} to {} would be right",
                                 *options.temperature_c, coldest_c, hottest_c));
}

/// Steps to a DN in which the mean of frames is stored.
int steps_for(int frames, double white_level_dn) {
  int steps = 1;
  while (2 * steps <= frames && 2 * steps * white_level_dn <= 65535) steps *= 2;
  return steps;
}

/// Linear values by stored ones, in 16 bits; levels and gain of the image become those of linear values.
void add_linearization(RawImage& raw, const Linearity& linearity, double greatest_stored) {
  const double black = raw.black_level, stored_dn_per_e = raw.dn_per_e;
  const double white_e = linearity.inverse((raw.white_level - black) / stored_dn_per_e);
  const double scale = (65535 - black) / white_e;
  for (double stored = 0; stored <= greatest_stored; ++stored) {
    const double e = linearity.inverse((stored - black) / stored_dn_per_e);
    raw.linearization.push_back(
        static_cast<std::uint16_t>(std::clamp(std::round(black + scale * e), 0.0, 65535.0)));
  }
  raw.white_level = 65535;
  raw.dn_per_e = scale;
}

}  // namespace

const std::vector<std::string>& noise_source_names() {
  static const std::vector<std::string> names = {"shot",      "dark",      "read",      "dsnu",
                                                 "prnu",      "column",    "row",       "defects",
                                                 "crosstalk", "microlens", "linearity", "blooming"};
  return names;
}

NoiseSource noise_source(const std::string& name) {
  const auto& names = noise_source_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw InputError(
        fmt::format("\"{}\" is no source of noise; these are: {}", name, fmt::join(names, ", ")));
  return static_cast<NoiseSource>(found - names.begin());
}

RawImage capture(const PhotoCurrent& current, const Sensor& sensor, double exposure_s,
                 const CaptureOptions& options) {
  const SensorElectronics& electronics = sensor.require_electronics();
  check(electronics, exposure_s, options);
  const Exposure exposure(current, sensor, exposure_s, options);
  const int steps = steps_for(options.frames, electronics.white_level_dn);

  RawImage raw;
  raw.columns = current.columns;
  raw.rows = current.rows;
  raw.mosaic = electronics.mosaic;
  raw.channels = electronics.channel_names();
  raw.samples.resize(current.e_per_s.size());
  raw.black_level = electronics.black_level_dn * steps;
  raw.white_level =
      std::floor(electronics.black_level_dn + exposure.dn_per_e() * exposure.saturation_e()) * steps;
  raw.dn_per_e = exposure.dn_per_e() * steps;
  raw.read_noise_e = exposure.read_noise_e() / std::sqrt(options.frames);
  if (options.frames > 1)  // the mean is rounded once more
    raw.read_noise_e = std::hypot(raw.read_noise_e, 1 / (std::sqrt(12.0) * raw.dn_per_e));
  raw.shot_noise_share = 1.0 / options.frames;
  raw.bad_pixels = exposure.bad_pixels();
  raw.exposure_s = exposure_s;
  raw.pitch_um = sensor.geometry.pitch_um;
  raw.sensor_name = sensor.name;

  const auto columns = static_cast<std::size_t>(current.columns);
  const double factor = static_cast<double>(steps) / options.frames;
  const auto store = [&](std::size_t row, std::span<const std::uint32_t> sums) {
    for (std::size_t c = 0; c < columns; ++c)
      raw.samples[row * columns + c] = static_cast<std::uint16_t>(std::floor(sums[c] * factor + 0.5));
  };
  if (exposure.blooms()) {
    std::vector<std::uint32_t> sums(raw.samples.size());
    for (int frame = options.first_frame; frame < options.first_frame + options.frames; ++frame) {
      const std::vector<double> bloomed = exposure.bloomed(frame);
      parallel_for(static_cast<std::size_t>(current.rows), [&](std::size_t row) {
        exposure.expose_row(static_cast<int>(row), frame, bloomed, {sums.data() + row * columns, columns});
      });
    }
    for (std::size_t row = 0; row < static_cast<std::size_t>(current.rows); ++row)
      store(row, {sums.data() + row * columns, columns});
  } else {
    parallel_for(static_cast<std::size_t>(current.rows), [&](std::size_t row) {
      std::vector<std::uint32_t> sums(columns);
      for (int frame = options.first_frame; frame < options.first_frame + options.frames; ++frame)
        exposure.expose_row(static_cast<int>(row), frame, {}, sums);
      store(row, sums);
    });
  }
  if (!exposure.linearity().is_exact())
    add_linearization(raw, exposure.linearity(), electronics.white_level_dn * steps);
  return raw;
}

}  // namespace petzval
