// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/imaging/scene_detail.h>
#include <petzval/numeric/fft.h>
#include <petzval/wave/photosite.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>

namespace petzval {

namespace {

constexpr double piece_pixels = 32;
constexpr std::size_t drawn_steps = 64;                ///< a pixel
constexpr double drawn_pixels = 0.25;                  ///< the width of strips of figures
constexpr std::size_t most_steps_of_strips = 1 << 20;  ///< looked at in each direction,
constexpr std::size_t least_strips = 32;               ///< if so many strips have no more

/// Strips of a scene that lie along its rows or its columns.
class Strips {
 public:
  Strips(const Scene& scene, int band, double samples_per_pixel, const SensorGeometry& sensor,
         bool along_columns)
      : light_(scene.band(band)),
        band_(static_cast<std::size_t>(band)),
        columns_(static_cast<std::size_t>(scene.columns())),
        along_columns_(along_columns),
        drawing_(scene.drawing()),
        samples_(samples_per_pixel),
        long_samples_(along_columns ? scene.rows() : scene.columns()),
        wide_samples_(along_columns ? scene.columns() : scene.rows()) {
    if (drawing_ == nullptr) {
      lines_ = static_cast<std::size_t>(std::clamp(samples_ + 0.5, 1.0, double(wide_samples_)));
      count_ = static_cast<std::size_t>(wide_samples_) / lines_;
      length_ = static_cast<std::size_t>(long_samples_);
    } else {
      // Of a chart that reaches beyond the frame, the middle.
      const double scene_long = long_samples_ / samples_, scene_wide = wide_samples_ / samples_;
      const double seen_long = std::min(scene_long, double(along_columns ? sensor.rows : sensor.columns)),
                   seen_wide = std::min(scene_wide, double(along_columns ? sensor.columns : sensor.rows));
      first_long_ = (scene_long - seen_long) / 2;
      first_wide_ = (scene_wide - seen_wide) / 2;
      count_ = std::max<std::size_t>(1, static_cast<std::size_t>(seen_wide / drawn_pixels));
      length_ = std::max<std::size_t>(1, static_cast<std::size_t>(seen_long * drawn_steps));
      lay_figures();
    }
  }

  std::size_t count() const { return count_; }
  std::size_t length() const { return length_; }  ///< steps
  double steps_per_pixel() const { return drawing_ == nullptr ? samples_ : double(drawn_steps); }
  /// From the middle of the scene to that of a strip [pixels].
  double aside(std::size_t strip) const {
    const double wide = drawing_ == nullptr ? double(lines_) / samples_ : drawn_pixels;
    return (double(strip) + 0.5) * wide + first_wide_ - double(wide_samples_) / samples_ / 2;
  }

  void write(std::size_t strip, std::vector<float>& values) const {
    values.assign(length_, 0.0F);
    if (drawing_ == nullptr) {
      for (std::size_t line = 0; line < lines_; ++line)
        for (std::size_t step = 0; step < length_; ++step)
          values[step] += sample(step, strip * lines_ + line) / static_cast<float>(lines_);
      return;
    }
    std::vector<float> covered(length_);
    const auto [from, end] = figures_->coverage(static_cast<int>(strip), covered, values);
    for (std::size_t step = 0; step < length_; ++step) {
      const bool within = step >= from && step < end;
      values[step] =
          (within ? values[step] : 0.0F) + (1 - (within ? covered[step] : 0.0F)) * ground(step, strip);
    }
  }

 private:
  std::size_t index_of(std::size_t along, std::size_t aside) const {
    return along_columns_ ? along * columns_ + aside : aside * columns_ + along;
  }
  float sample(std::size_t along, std::size_t aside) const { return light_[index_of(along, aside)]; }

  float ground(std::size_t step, std::size_t strip) const {
    const float plain = drawing_->ground[band_];
    if (!drawing_->texture) return plain;
    // Along a line of samples.
    const auto line =
        std::min(static_cast<std::size_t>(((double(strip) + 0.5) * drawn_pixels + first_wide_) * samples_),
                 static_cast<std::size_t>(wide_samples_) - 1);
    const double at = std::clamp(((double(step) + 0.5) / double(drawn_steps) + first_long_) * samples_ - 0.5,
                                 0.0, double(long_samples_) - 1);
    const auto before = static_cast<std::size_t>(at);
    const std::size_t after = std::min(before + 1, static_cast<std::size_t>(long_samples_) - 1);
    const std::vector<float>& texture = *drawing_->texture;
    const float first = texture[index_of(before, line)], second = texture[index_of(after, line)];
    return plain * (first + static_cast<float>(at - double(before)) * (second - first));
  }

  void lay_figures() {
    std::vector<Shape> laid(drawing_->figures.size());
    std::vector<ShapesInPicture::Valued> valued;
    const auto place = [&](Point sample) {
      if (along_columns_) std::swap(sample.x, sample.y);
      return Point{(sample.x / samples_ - first_long_) * double(drawn_steps),
                   (sample.y / samples_ - first_wide_) / drawn_pixels};
    };
    for (std::size_t i = 0; i < laid.size(); ++i) {
      const SceneDrawing::Figure& figure = drawing_->figures[i];
      for (const Shape::Edge& edge : figure.shape->edges()) {
        // A swap of axes mirrors the figure, whose edges then run the other way about.
        const Point from = place(edge.from), to = place(edge.to);
        laid[i].add_edge(along_columns_ ? Shape::Edge{to, from} : Shape::Edge{from, to});
      }
      valued.push_back({&laid[i], double(figure.radiance[band_])});
    }
    figures_.emplace(valued, static_cast<int>(length_), static_cast<int>(count_));
  }

  std::span<const float> light_;
  std::size_t band_, columns_;
  bool along_columns_;
  const SceneDrawing* drawing_;
  double samples_;  ///< a pixel
  int long_samples_, wide_samples_;
  double first_long_ = 0, first_wide_ = 0;  ///< where strips of figures begin [pixels]
  std::size_t count_ = 0, length_ = 0, lines_ = 1;
  std::optional<ShapesInPicture> figures_;
};

/// Power spectra of pieces of strips, zone by zone.
class PieceSpectra {
 public:
  PieceSpectra(const Strips& strips, const SensorGeometry& sensor, bool along_columns, bool everywhere)
      : strips_(strips), zones_(sensor), everywhere_(everywhere), pitch_mm_(sensor.pitch_um * mm_per_um) {
    half_long_ = (along_columns ? sensor.rows : sensor.columns) / 2.0;
    half_wide_ = (along_columns ? sensor.columns : sensor.rows) / 2.0;
    if (everywhere_) half_long_ = half_wide_ = INFINITY;
    constexpr std::size_t least = 128;  // steps
    while (size_ * 2 <= strips.length() &&
           (size_ < least || double(size_) < piece_pixels * strips.steps_per_pixel()))
      size_ *= 2;
    for (std::size_t i = 0; i < size_; ++i)
      window_.push_back(float(0.5 - 0.5 * std::cos(2 * pi * (double(i) + 0.5) / double(size_))));
  }

  std::size_t size() const { return size_; }

  struct Sums {
    std::array<std::vector<double>, FrameZones::count> power;  ///< by cycles in a piece
    double mean = 0, pieces = 0;
  };

  Sums all() const {
    const std::size_t every = std::max<std::size_t>(
        1,
        std::min(strips_.count() * strips_.length() / most_steps_of_strips, strips_.count() / least_strips));
    // Blocks do not depend on the number of threads, nor does the order in which they are added up.
    constexpr std::size_t blocks = 32;
    std::vector<Sums> parts(blocks);
    parallel_for(blocks, [&](std::size_t block) {
      Sums& sums = parts[block] = none();
      const RealFft2<float> fft(1, static_cast<int>(size_));
      Work work{
          AlignedVector<float>(fft.size()), AlignedVector<std::complex<float>>(fft.spectrum_size()), {}};
      for (std::size_t strip = every / 2 + block * every; strip < strips_.count(); strip += blocks * every)
        add_strip(strip, fft, work, sums);
    });
    Sums total = none();
    for (const Sums& part : parts) {
      for (std::size_t zone = 0; zone < FrameZones::count; ++zone)
        for (std::size_t k = 0; k <= size_ / 2; ++k) total.power[zone][k] += part.power[zone][k];
      total.mean += part.mean;
      total.pieces += part.pieces;
    }
    return total;
  }

 private:
  struct Work {
    AlignedVector<float> piece;
    AlignedVector<std::complex<float>> spectrum;
    std::vector<float> values;
  };

  Sums none() const {
    Sums sums;
    sums.power.fill(std::vector<double>(size_ / 2 + 1));
    return sums;
  }

  void add_strip(std::size_t strip, const RealFft2<float>& fft, Work& work, Sums& sums) const {
    const double aside = strips_.aside(strip);
    if (std::abs(aside) > half_wide_) return;
    strips_.write(strip, work.values);
    double of_window = 0, squares = 0;
    for (const float weight : window_) {
      of_window += double(weight);
      squares += double(weight) * double(weight);
    }
    for (std::size_t from = 0; from + size_ <= strips_.length();
         from += std::max<std::size_t>(1, size_ / 2)) {
      const double along =
          (double(from) + double(size_) / 2 - double(strips_.length()) / 2) / strips_.steps_per_pixel();
      if (std::abs(along) > half_long_) continue;
      double mean = 0;
      for (std::size_t i = 0; i < size_; ++i) mean += double(window_[i]) * double(work.values[from + i]);
      mean /= of_window;
      for (std::size_t i = 0; i < size_; ++i)
        work.piece[i] = window_[i] * (work.values[from + i] - static_cast<float>(mean));
      fft.forward(work.piece, work.spectrum);
      const double square = along * along + aside * aside;
      const double of_radius = square > 0 ? along * along / square : 0.5;
      // A panorama is seen from wherever the camera looks.
      const std::size_t ring = everywhere_ ? static_cast<std::size_t>(sums.pieces) % FrameZones::rings
                                           : zones_.ring_at(std::sqrt(square) * pitch_mm_);
      for (std::size_t k = 1; k <= size_ / 2; ++k) {
        const double power =
            (2 * k == size_ ? 1 : 2) * double(std::norm(work.spectrum[k])) / (double(size_) * squares);
        sums.power[FrameZones::along_radius(ring)][k] += of_radius * power;
        sums.power[FrameZones::across_radius(ring)][k] += (1 - of_radius) * power;
      }
      sums.mean += mean;
      sums.pieces += 1;
    }
  }

  const Strips& strips_;
  FrameZones zones_;
  bool everywhere_;
  double pitch_mm_, half_long_, half_wide_;
  std::size_t size_ = 1;  ///< of a piece [steps]
  std::vector<float> window_;
};

double variance_of_neighbours(const Scene& scene, int band) {
  const std::span<const float> light = scene.band(band);
  const auto columns = static_cast<std::size_t>(scene.columns()),
             rows = static_cast<std::size_t>(scene.rows());
  std::vector<double> sums(rows);
  parallel_for(rows, [&](std::size_t row) {
    const float* here = &light[row * columns];
    const auto add = [&](float step) { sums[row] += double(step) * double(step); };
    for (std::size_t column = 1; column < columns; ++column) add(here[column] - here[column - 1]);
    if (row != 0)
      for (std::size_t column = 0; column < columns; ++column) add(here[column] - (here - columns)[column]);
  });
  double sum = 0;
  for (const double one : sums) sum += one;
  const std::size_t steps = rows * (columns - 1) + (rows - 1) * columns;
  return steps == 0 ? 0 : sum / double(2 * steps);
}

}  // namespace

double contrast_of_samples(const Scene& scene, int band) {
  double mean = 0;
  for (const float light : scene.band(band)) mean += double(light);
  mean /= static_cast<double>(scene.band(band).size());
  return mean > 0 ? std::sqrt(variance_of_neighbours(scene, band)) / mean : 0;
}

SceneDetail detail_of(const Scene& scene, int band, double samples_per_pixel, const SensorGeometry& sensor) {
  SceneDetail detail;
  detail.power.fill(std::vector<double>(DetailBands::count));
  detail.variance_of_neighbours = variance_of_neighbours(scene, band);
  if (!(samples_per_pixel > 0 && std::isfinite(samples_per_pixel))) return detail;
  double pieces = 0;
  const auto add = [&](std::size_t zone, double f_cpp, double power) {
    const double at = f_cpp / DetailBands::step_cpp;
    if (at < double(DetailBands::count)) detail.power[zone][static_cast<std::size_t>(at)] += power;
  };
  for (const bool along_columns : {false, true}) {
    const Strips strips(scene, band, samples_per_pixel, sensor, along_columns);
    const PieceSpectra spectra(strips, sensor, along_columns, scene.is_panorama());
    const PieceSpectra::Sums sums = spectra.all();
    if (sums.pieces == 0) continue;
    detail.mean += sums.mean;
    pieces += sums.pieces;
    for (std::size_t zone = 0; zone < FrameZones::count; ++zone)
      for (std::size_t k = 1; k < sums.power[zone].size(); ++k) {
        const double cycles = double(k) / double(spectra.size()), power = sums.power[zone][k] / sums.pieces;
        if (scene.drawing() != nullptr) {
          add(zone, cycles * strips.steps_per_pixel(), power);
          continue;
        }
        // Straight lines between samples: less of this, and some of its images.
        constexpr int images = 3;
        for (int image = 0; image <= images; ++image)
          for (const double at : {image - cycles, image + cycles})
            if (at > 0) add(zone, at * strips.steps_per_pixel(), power * std::pow(sinc(at), 4));
      }
  }
  if (pieces != 0) detail.mean /= pieces;
  return detail;
}

double KnownDetail::rounded_scale(double samples_per_pixel) {
  constexpr double steps = 64;
  return std::exp2(std::round(steps * std::log2(samples_per_pixel)) / steps);
}

const SceneDetail& KnownDetail::of(const Scene& scene, int band, double samples_per_pixel,
                                   const SensorGeometry& sensor) {
  const Key key{band, rounded_scale(samples_per_pixel), sensor.columns, sensor.rows, sensor.pitch_um};
  for (const Known& known : known_)
    if (known.key == key) return known.detail;
  constexpr std::size_t most = 4;  // a frame and its tails, at two scales
  SceneDetail detail = detail_of(scene, band, key.samples_per_pixel, sensor);
  ++looks_;
  if (known_.size() == most) known_.pop_front();
  return known_.emplace_back(Known{key, std::move(detail)}).detail;
}

}  // namespace petzval
