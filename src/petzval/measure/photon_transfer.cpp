// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/measure/photon_transfer.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

constexpr double quantisation_variance = 1.0 / 12;
constexpr double linear_share = 0.7;  // of saturation, for the gain

/// Calls visit(index) for all pixels of a channel.
template <typename Visit>
void for_channel(const RawImage& raw, int channel, const Visit& visit) {
  for (int row = 0; row < raw.rows; ++row)
    for (int column = 0; column < raw.columns; ++column)
      if (raw.mosaic.channel(row, column) == channel) visit(row, column);
}

void check_pair(const RawImage& a, const RawImage& b, int channel) {
  if (a.columns != b.columns || a.rows != b.rows || a.mosaic != b.mosaic)
    throw InputError("exposures to compare must have one size and one mosaic");
  if (channel < 0 || channel >= static_cast<int>(a.channels.size()))
    throw InputError(fmt::format("channel {} of {}", channel, a.channels.size()));
}

struct MeanAndVariance {
  double mean = 0, variance = 0;
};

MeanAndVariance of_values(const std::vector<double>& values) {
  if (values.size() < 2) throw InputError("a channel with fewer than two pixels has no noise to measure");
  MeanAndVariance result;
  for (const double value : values) result.mean += value;
  result.mean /= static_cast<double>(values.size());
  for (const double value : values) result.variance += (value - result.mean) * (value - result.mean);
  result.variance /= static_cast<double>(values.size() - 1);
  return result;
}

/// Mean over pixels and true spatial variance of a stack.
MeanAndVariance spatial(std::span<const RawImage> stack, int channel) {
  if (stack.size() < 2) throw InputError("a stack of exposures needs two at least");
  for (const RawImage& raw : stack) check_pair(stack[0], raw, channel);
  std::vector<double> means, temporal;
  for_channel(stack[0], channel, [&](int row, int column) {
    std::vector<double> values;
    for (const RawImage& raw : stack) values.push_back(raw.pixel(row, column));
    const MeanAndVariance pixel = of_values(values);
    means.push_back(pixel.mean);
    temporal.push_back(pixel.variance);
  });
  MeanAndVariance result = of_values(means);
  result.variance -= of_values(temporal).mean / static_cast<double>(stack.size());
  return result;
}

/// Slope of y over x through the origin.
double slope(const std::vector<double>& x, const std::vector<double>& y) {
  double xy = 0, xx = 0;
  for (std::size_t i = 0; i < x.size(); ++i) xy += x[i] * y[i], xx += x[i] * x[i];
  return xy / xx;
}

}  // namespace

TransferPoint transfer_point(const RawImage& first, const RawImage& second, int channel) {
  check_pair(first, second, channel);
  std::vector<double> sums, differences;
  for_channel(first, channel, [&](int row, int column) {
    const double a = first.pixel(row, column), b = second.pixel(row, column);
    sums.push_back((a + b) / 2);
    differences.push_back(a - b);
  });
  return {first.exposure_s, of_values(sums).mean, of_values(differences).variance / 2};
}

PhotonTransfer photon_transfer(std::vector<TransferPoint> points) {
  constexpr std::size_t least = 3;
  if (points.size() < least)
    throw InputError("a photon-transfer curve needs a dark point and two with light");
  const TransferPoint dark = points.front();
  std::sort(points.begin() + 1, points.end(),
            [](const TransferPoint& a, const TransferPoint& b) { return a.mean_dn < b.mean_dn; });
  const auto saturation =
      std::max_element(points.begin(), points.end(), [](const TransferPoint& a, const TransferPoint& b) {
        return a.temporal_variance_dn2 < b.temporal_variance_dn2;
      });
  const double saturation_dn = saturation->mean_dn - dark.mean_dn;
  std::vector<double> x, y;
  for (const TransferPoint& point : points) {
    if (&point == &points.front() || point.mean_dn - dark.mean_dn > linear_share * saturation_dn) continue;
    x.push_back(point.mean_dn - dark.mean_dn);
    y.push_back(point.temporal_variance_dn2 - dark.temporal_variance_dn2);
  }
  PhotonTransfer result;
  if (!x.empty()) result.dn_per_e = slope(x, y);
  if (!(result.dn_per_e > 0))
    throw InputError("these exposures give no gain; more levels of light below saturation would be right");
  result.dark_noise_e =
      std::sqrt(std::max(0.0, dark.temporal_variance_dn2 - quantisation_variance)) / result.dn_per_e;
  result.saturation_e = saturation_dn / result.dn_per_e;
  const double dark_e2 = dark.temporal_variance_dn2 / (result.dn_per_e * result.dn_per_e);
  const double least_e = std::sqrt(dark_e2 + 0.25) + 0.5;  // its signal-to-noise ratio is 1
  result.dynamic_range_db = 20 * std::log10(result.saturation_e / least_e);
  result.snr_max_db = 10 * std::log10(result.saturation_e);
  result.points = std::move(points);
  return result;
}

NonUniformity non_uniformity(std::span<const RawImage> dark, std::span<const RawImage> half, int channel,
                             double dn_per_e) {
  const MeanAndVariance in_dark = spatial(dark, channel), in_light = spatial(half, channel);
  NonUniformity result;
  result.dsnu_e = std::sqrt(std::max(0.0, in_dark.variance)) / dn_per_e;
  result.prnu_percent =
      100 * std::sqrt(std::max(0.0, in_light.variance - in_dark.variance)) / (in_light.mean - in_dark.mean);
  return result;
}

SensorTest test_sensor(const Sensor& sensor, const CaptureOptions& options, int channel, int side, int levels,
                       int stack) {
  const SensorElectronics& electronics = sensor.require_electronics();
  const int columns = std::min(side, sensor.geometry.columns), rows = std::min(side, sensor.geometry.rows);
  const double saturation_e =
      electronics.saturation_e(electronics.gain_mode(options.gain_mode), options.analog_gain);
  constexpr double second = 1;
  CaptureOptions each = options;
  const auto expose = [&](double electrons) {
    PhotoCurrent light{
        columns, rows, (sensor.geometry.columns - columns) / 2, (sensor.geometry.rows - rows) / 2, {}};
    light.first_column -= light.first_column % electronics.mosaic.columns;
    light.first_row -= light.first_row % electronics.mosaic.rows;
    // The exposure stays short and the light changes, so that dark current does not.
    constexpr double exposure_s = 0.01;
    light.e_per_s.assign(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows),
                         static_cast<float>(electrons * second / exposure_s));
    ++each.seed;
    return capture(light, sensor, exposure_s, each);
  };
  std::vector<TransferPoint> points{transfer_point(expose(0), expose(0), channel)};
  constexpr double beyond = 1.2;
  for (int i = 1; i <= levels; ++i) {
    const double electrons = beyond * saturation_e * i / levels;
    points.push_back(transfer_point(expose(electrons), expose(electrons), channel));
  }
  SensorTest result{photon_transfer(points), {}};
  std::vector<RawImage> dark, half;
  for (int i = 0; i < stack; ++i) dark.push_back(expose(0)), half.push_back(expose(saturation_e / 2));
  result.uniformity = non_uniformity(dark, half, channel, result.transfer.dn_per_e);
  return result;
}

}  // namespace petzval
