// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/numeric/interpolation.h>
#include <petzval/sensor/photo_current.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

// SI constants of 2019, exact.
constexpr double planck_js = 6.62607015e-34, light_speed_m_per_s = 299792458;
constexpr double m_per_nm = 1e-9, m_per_um = 1e-6;

double photons_per_joule_nm(double pitch_um) {
  const double side_m = pitch_um * m_per_um;
  return side_m * side_m * m_per_nm / (planck_js * light_speed_m_per_s);
}

/// ∫ hat(λ) η(λ) λ dλ over one flank of the hat, from its foot to its top: cubic between the samples of η, so
/// that Simpson's rule is exact.
double flank(const Spectrum& efficiency, double foot_nm, double top_nm) {
  const double from = std::min(foot_nm, top_nm), to = std::max(foot_nm, top_nm);
  std::vector<double> knots{from};
  for (const double nm : efficiency.wavelengths_nm())
    if (nm > from && nm < to) knots.push_back(nm);
  knots.push_back(to);
  // A spectrum falls to zero at its ends at once: values are taken just inside each piece.
  const auto inside = [&](double nm, double middle) {
    const double nudge = 1e-9 * (middle - nm);
    return efficiency.at(nm + nudge) * nm * (nm - foot_nm) / (top_nm - foot_nm);
  };
  double sum = 0;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const double middle = (knots[i] + knots[i + 1]) / 2;
    sum += (knots[i + 1] - knots[i]) / 6 *
           (inside(knots[i], middle) + 4 * inside(middle, middle) + inside(knots[i + 1], middle));
  }
  return sum;
}

void check_match(const SpectralImage& image, const Sensor& sensor) {
  const SensorGeometry& frame = sensor.geometry;
  constexpr double same_pitch = 1e-6;
  if (std::abs(image.pitch_um() / frame.pitch_um - 1) > same_pitch)
    throw InputError(
        fmt::format("the irradiance has pixels of {:g} um, sensor {} has pixels of {:g} um; an irradiance "
                    "made with `sensor` for this sensor would be right",
                    image.pitch_um(), sensor.name, frame.pitch_um));
  if (image.columns() > frame.columns || image.rows() > frame.rows)
    throw InputError(fmt::format("the irradiance has {} x {} pixels, sensor {} only {} x {}", image.columns(),
                                 image.rows(), sensor.name, frame.columns, frame.rows));
  const std::string aperture = image.pixel_aperture() == PixelAperture::box     ? "box"
                               : image.pixel_aperture() == PixelAperture::point ? "point"
                                                                                : image.photosite;
  if (aperture != sensor.photosite.text())
    throw InputError(
        fmt::format("the irradiance is integrated over the pixel aperture \"{}\", the photosite of sensor "
                    "{} is \"{}\"; whoever makes the irradiance applies it, once",
                    aperture, sensor.name, sensor.photosite.text()));
}

/// The weights of one row of the mosaic, repeated over enough columns for long loops.
struct RowWeights {
  std::size_t width = 0;
  std::vector<double> values;  ///< [band][column]
};

std::vector<RowWeights> weights_by_row(const SpectralImage& image, const Sensor& sensor) {
  const SensorElectronics& electronics = *sensor.electronics;
  std::vector<std::vector<double>> by_channel;
  for (const SensorChannel& channel : electronics.channels)
    by_channel.push_back(
        electron_weights(channel.quantum_efficiency, image.wavelengths_nm(), image.pitch_um()));
  constexpr std::size_t least_width = 256;
  const auto period = static_cast<std::size_t>(electronics.mosaic.columns);
  std::vector<RowWeights> rows(static_cast<std::size_t>(electronics.mosaic.rows));
  for (std::size_t r = 0; r < rows.size(); ++r) {
    rows[r].width = period * ((least_width + period - 1) / period);
    for (std::size_t band = 0; band < image.wavelengths_nm().size(); ++band)
      for (std::size_t c = 0; c < rows[r].width; ++c)
        rows[r].values.push_back(by_channel[static_cast<std::size_t>(
            electronics.mosaic.channel(static_cast<int>(r), static_cast<int>(c)))][band]);
  }
  return rows;
}

/// Rows whose memory is kept before that of all is given back.
constexpr std::size_t rows_kept = 64;

void add_up_row(const SpectralImage& image, const RowWeights& weights, std::size_t row,
                std::span<float> current) {
  const auto columns = static_cast<std::size_t>(image.columns());
  std::vector<double> sums(weights.width);
  for (std::size_t left = 0; left < columns; left += weights.width) {
    const std::size_t count = std::min(weights.width, columns - left);
    std::fill(sums.begin(), sums.end(), 0.0);
    for (int band = 0; band < image.bands(); ++band) {
      const float* light = image.band(band).data() + row * columns + left;
      const double* weight = weights.values.data() + static_cast<std::size_t>(band) * weights.width;
      double* sum = sums.data();
      for (std::size_t c = 0; c < count; ++c) sum[c] += weight[c] * static_cast<double>(light[c]);
    }
    for (std::size_t c = 0; c < count; ++c) {
      if (!std::isfinite(sums[c]))
        throw InputError(fmt::format("the irradiance in row {}, column {} is not a number", row, left + c));
      current[left + c] = static_cast<float>(std::max(0.0, sums[c]));
    }
  }
}

// ---- microlens

/// Linear, held beyond the ends.
double along(const std::vector<double>& x, const std::vector<double>& y, double at) {
  if (x.size() == 1 || at <= x.front()) return y.front();
  if (at >= x.back()) return y.back();
  const std::size_t i = bracket(x, at);
  return y[i] + (y[i + 1] - y[i]) * (at - x[i]) / (x[i + 1] - x[i]);
}

double microlens_response(const Microlens& lens, double height_mm, double exit_pupil_mm) {
  // The chief ray comes from the middle of the exit pupil.
  const double angle_deg = degrees(std::atan(height_mm / std::abs(exit_pupil_mm)));
  const double best_deg =
      lens.design_heights_mm.empty() ? 0 : along(lens.design_heights_mm, lens.design_angles_deg, height_mm);
  return along(lens.angles_deg, lens.response, std::abs(angle_deg - best_deg));
}

double exit_pupil_mm(const SpectralImage& image, const PhotoCurrentOptions& options) {
  if (options.exit_pupil_mm) return *options.exit_pupil_mm;
  if (image.lens && image.lens->exit_pupil_mm != 0) return image.lens->exit_pupil_mm;
  throw InputError(
      "the sensor's microlens needs chief ray angles, and the irradiance does not say where the exit pupil "
      "is; `exit_pupil_mm` MM or `without` microlens would be right");
}

void apply_microlens(PhotoCurrent& current, const Sensor& sensor, double pupil_mm) {
  const SensorGeometry& frame = sensor.geometry;
  parallel_for(static_cast<std::size_t>(current.rows), [&](std::size_t row) {
    const double y = frame.y_mm(static_cast<double>(row) + current.first_row + 0.5);
    float* values = current.e_per_s.data() + row * static_cast<std::size_t>(current.columns);
    for (int column = 0; column < current.columns; ++column) {
      const double height = std::hypot(frame.x_mm(column + current.first_column + 0.5), y);
      values[column] *=
          static_cast<float>(microlens_response(*sensor.electronics->microlens, height, pupil_mm));
    }
  });
}

// ---- crosstalk

/// Mirrored at the edge, so that a neighbour beyond it has the colour that it would have.
int mirrored(int index, int count) {
  if (index < 0) index = -index;
  if (index >= count) index = 2 * count - 2 - index;
  return std::clamp(index, 0, count - 1);
}

void apply_crosstalk(PhotoCurrent& current, const std::array<std::array<double, 3>, 3>& shares) {
  const std::vector<float> before = current.e_per_s;
  const auto columns = static_cast<std::size_t>(current.columns);
  parallel_for(static_cast<std::size_t>(current.rows), [&](std::size_t row) {
    for (int column = 0; column < current.columns; ++column) {
      double sum = 0;
      for (int r = -1; r <= 1; ++r)
        for (int c = -1; c <= 1; ++c) {
          // What a neighbour at (−r, −c) sends in the direction (r, c).
          const auto from_row = static_cast<std::size_t>(mirrored(static_cast<int>(row) - r, current.rows));
          const auto from_column = static_cast<std::size_t>(mirrored(column - c, current.columns));
          sum += shares[static_cast<std::size_t>(r + 1)][static_cast<std::size_t>(c + 1)] *
                 static_cast<double>(before[from_row * columns + from_column]);
        }
      current.e_per_s[row * columns + static_cast<std::size_t>(column)] = static_cast<float>(sum);
    }
  });
}

bool shares_light(const std::array<std::array<double, 3>, 3>& shares) {
  return shares != SensorElectronics{}.crosstalk;
}

/// Of evenly lit pixels, by channel: the mean over the cells of the mosaic.
std::vector<double> after_crosstalk(const std::vector<double>& currents,
                                    const SensorElectronics& electronics) {
  const Mosaic& mosaic = electronics.mosaic;
  std::vector<double> sums(currents.size()), counts(currents.size());
  for (int row = 0; row < mosaic.rows; ++row)
    for (int column = 0; column < mosaic.columns; ++column) {
      const auto channel = static_cast<std::size_t>(mosaic.channel(row, column));
      ++counts[channel];
      for (int r = -1; r <= 1; ++r)
        for (int c = -1; c <= 1; ++c)  // what a neighbour at (−r, −c) sends in the direction (r, c)
          sums[channel] +=
              electronics.crosstalk[static_cast<std::size_t>(r + 1)][static_cast<std::size_t>(c + 1)] *
              currents[static_cast<std::size_t>(
                  mosaic.channel(row - r + mosaic.rows, column - c + mosaic.columns))];
    }
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] /= counts[i];
  return sums;
}

/// The first pixel of a frame of `size` in the middle of `whole`, at a multiple of the mosaic's period.
int first_in_middle(int whole, int size, int period) {
  return (whole - size) / 2 / period * period;
}

}  // namespace

std::vector<double> electron_weights(const Spectrum& quantum_efficiency,
                                     std::span<const double> wavelengths_nm, double pitch_um) {
  const double factor = photons_per_joule_nm(pitch_um);
  if (wavelengths_nm.size() == 1)
    return {factor * quantum_efficiency.at(wavelengths_nm[0]) * wavelengths_nm[0]};
  std::vector<double> weights(wavelengths_nm.size());
  for (std::size_t i = 0; i + 1 < wavelengths_nm.size(); ++i) {
    weights[i] += factor * flank(quantum_efficiency, wavelengths_nm[i + 1], wavelengths_nm[i]);
    weights[i + 1] += factor * flank(quantum_efficiency, wavelengths_nm[i], wavelengths_nm[i + 1]);
  }
  return weights;
}

PhotoCurrent photo_current(const SpectralImage& image, const Sensor& sensor,
                           const PhotoCurrentOptions& options) {
  const SensorElectronics& electronics = sensor.require_electronics();
  check_match(image, sensor);
  PhotoCurrent current;
  current.columns = image.columns();
  current.rows = image.rows();
  current.first_column =
      first_in_middle(sensor.geometry.columns, image.columns(), electronics.mosaic.columns);
  current.first_row = first_in_middle(sensor.geometry.rows, image.rows(), electronics.mosaic.rows);
  current.e_per_s.resize(image.band_size());

  const std::vector<RowWeights> weights = weights_by_row(image, sensor);
  const auto columns = static_cast<std::size_t>(image.columns());
  parallel_for(static_cast<std::size_t>(image.rows()), [&](std::size_t row) {
    add_up_row(image, weights[row % weights.size()], row,
               std::span(current.e_per_s).subspan(row * columns, columns));
    if (row % rows_kept == 0) image.release_memory();
  });
  if (electronics.microlens && options.microlens)
    apply_microlens(current, sensor, exit_pupil_mm(image, options));
  if (options.crosstalk && shares_light(electronics.crosstalk))
    apply_crosstalk(current, electronics.crosstalk);
  return current;
}

std::vector<double> channel_means(const PhotoCurrent& current, const SensorElectronics& electronics) {
  std::vector<double> sums(electronics.channels.size()), counts(electronics.channels.size());
  for (int row = 0; row < current.rows; ++row)
    for (int column = 0; column < current.columns; ++column) {
      const auto channel = static_cast<std::size_t>(electronics.mosaic.channel(row, column));
      sums[channel] += static_cast<double>(
          current.e_per_s[static_cast<std::size_t>(row) * static_cast<std::size_t>(current.columns) +
                          static_cast<std::size_t>(column)]);
      ++counts[channel];
    }
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] /= std::max(1.0, counts[i]);
  return sums;
}

std::vector<double> channel_currents(const Sensor& sensor, const Spectrum& irradiance) {
  std::vector<double> currents;
  for (const SensorChannel& channel : sensor.require_electronics().channels) {
    const auto weights =
        electron_weights(channel.quantum_efficiency, irradiance.wavelengths_nm(), sensor.geometry.pitch_um);
    double sum = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] * irradiance.values()[i];
    currents.push_back(sum);
  }
  return shares_light(sensor.electronics->crosstalk) ? after_crosstalk(currents, *sensor.electronics)
                                                     : currents;
}

}  // namespace petzval
