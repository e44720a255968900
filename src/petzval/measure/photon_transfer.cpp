// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/measure/photon_transfer.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace petzval {

namespace {

constexpr double quantisation_variance = 1.0 / 12;
constexpr double linear_share = 0.7;  // of saturation, for the gain
// EMVA 1288, section 6.6: less variance [DN²] than this tells of the steps and no more of the noise, which is
// then said to be below √(0.24 − 1/12) DN.
constexpr double least_told_variance = 0.24;

double hidden_noise_dn() {
  return std::sqrt(least_told_variance - quantisation_variance);
}

/// Linear values per stored step at black.
double stored_step(const RawImage& raw) {
  const auto& table = raw.linearization;
  const auto black = std::lower_bound(table.begin(), table.end(), raw.black_level);
  constexpr std::ptrdiff_t part = 64;  // of the codes above black: fine enough to be straight
  const std::ptrdiff_t codes = std::max<std::ptrdiff_t>(1, (table.end() - black) / part);
  if (table.end() - black <= codes || black[codes] <= black[0]) return 1;
  return static_cast<double>(black[codes] - black[0]) / static_cast<double>(codes);
}

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
struct StackStatistics {
  double mean = 0, variance = 0, temporal = 0;
};

StackStatistics spatial(std::span<const RawImage> stack, int channel) {
  if (stack.size() < 2) throw InputError("a stack of exposures needs two at least");
  for (const RawImage& raw : stack) check_pair(stack[0], raw, channel);
  const double step = stored_step(stack[0]);
  std::vector<double> means, temporal;
  for_channel(stack[0], channel, [&](int row, int column) {
    std::vector<double> values;
    for (const RawImage& raw : stack) values.push_back(raw.pixel(row, column) / step);
    const MeanAndVariance pixel = of_values(values);
    means.push_back(pixel.mean);
    temporal.push_back(pixel.variance);
  });
  const MeanAndVariance over_pixels = of_values(means);
  const double noise = of_values(temporal).mean;
  return {over_pixels.mean, over_pixels.variance - noise / static_cast<double>(stack.size()), noise};
}

/// Slope of y over x through the origin.
double slope(const std::vector<double>& x, const std::vector<double>& y) {
  double xy = 0, xx = 0;
  for (std::size_t i = 0; i < x.size(); ++i) xy += x[i] * y[i], xx += x[i] * x[i];
  return xy / xx;
}

// Variances of single pairs scatter more than the curve bends where it turns.
constexpr int pairs_at_turn = 4;

template <typename Pair>
TransferPoint mean_of_pairs(int count, const Pair& pair) {
  TransferPoint sum;
  for (int i = 0; i < count; ++i) {
    const TransferPoint point = pair();
    sum.exposure_s = point.exposure_s;
    sum.mean_dn += point.mean_dn / count;
    sum.temporal_variance_dn2 += point.temporal_variance_dn2 / count;
  }
  return sum;
}

}  // namespace

TransferPoint transfer_point(const RawImage& first, const RawImage& second, int channel) {
  check_pair(first, second, channel);
  const double step = stored_step(first);
  std::vector<double> sums, differences;
  for_channel(first, channel, [&](int row, int column) {
    const double a = first.pixel(row, column) / step, b = second.pixel(row, column) / step;
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
  result.quantisation_limited = dark.temporal_variance_dn2 < least_told_variance;
  const double dark_variance = std::max(dark.temporal_variance_dn2, least_told_variance);
  result.dark_noise_e = std::sqrt(dark_variance - quantisation_variance) / result.dn_per_e;
  result.saturation_e = saturation_dn / result.dn_per_e;
  constexpr double full_share = 0.5;  // of the greatest variance; less is left only by clipping
  if (points.back().temporal_variance_dn2 < full_share * saturation->temporal_variance_dn2)
    result.full_signal_e = (points.back().mean_dn - dark.mean_dn) / result.dn_per_e;
  const double dark_e2 = dark_variance / (result.dn_per_e * result.dn_per_e);
  const double least_e = std::sqrt(dark_e2 + 0.25) + 0.5;  // its signal-to-noise ratio is 1
  result.dynamic_range_db = 20 * std::log10(result.saturation_e / least_e);
  result.snr_max_db = 10 * std::log10(result.saturation_e);
  result.points = std::move(points);
  return result;
}

NonUniformity non_uniformity(std::span<const RawImage> dark, std::span<const RawImage> half, int channel,
                             double dn_per_e) {
  const StackStatistics in_dark = spatial(dark, channel), in_light = spatial(half, channel);
  NonUniformity result;
  // Noise and pattern together carry the values over the steps, or not.
  result.dsnu_quantisation_limited = in_dark.variance + in_dark.temporal < least_told_variance;
  result.dsnu_e =
      (result.dsnu_quantisation_limited ? hidden_noise_dn() : std::sqrt(std::max(0.0, in_dark.variance))) /
      dn_per_e;
  result.prnu_percent =
      100 * std::sqrt(std::max(0.0, in_light.variance - in_dark.variance)) / (in_light.mean - in_dark.mean);
  return result;
}

GreyNoise grey_noise(std::span<const RawImage> dark, std::span<const RawImage> grey, int channel,
                     const PhotonTransfer& transfer) {
  const auto noise_e = [&](std::span<const RawImage> stack) {
    std::vector<std::vector<double>> exposures;
    for (const RawImage& raw : stack) {
      const double step_e = stored_step(raw) * transfer.dn_per_e;
      std::vector<double>& values = exposures.emplace_back();
      for_channel(raw, channel,
                  [&](int row, int column) { values.push_back(raw.pixel(row, column) / step_e); });
    }
    return patch_noise(exposures);
  };
  const PatchNoise in_dark = noise_e(dark), noise = noise_e(grey);
  const double signal_e = noise.mean - in_dark.mean;
  return {signal_e, signal_e / noise.total(), signal_e / noise.temporal, signal_e / noise.fixed_pattern,
          20 * std::log10(transfer.saturation_e / in_dark.temporal)};
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
  const double coarse_e = beyond * saturation_e / levels;
  const auto point_at = [&](double electrons) {
    return transfer_point(expose(electrons), expose(electrons), channel);
  };
  int turn = 1;
  for (int i = 1; i <= levels; ++i) {
    points.push_back(point_at(coarse_e * i));
    if (points.back().temporal_variance_dn2 > points[static_cast<std::size_t>(turn)].temporal_variance_dn2)
      turn = i;
  }
  for (int i = 1; i < levels; ++i)
    points.push_back(
        mean_of_pairs(pairs_at_turn, [&] { return point_at(coarse_e * (turn - 1 + 2.0 * i / levels)); }));
  SensorTest result{photon_transfer(points), {}, {}};
  std::vector<RawImage> dark, half, grey;
  for (int i = 0; i < stack; ++i) dark.push_back(expose(0)), half.push_back(expose(saturation_e / 2));
  const double grey_e = 0.18 / std::numbers::sqrt2 * saturation_e;
  for (int i = 0; i < stack; ++i) grey.push_back(expose(grey_e));
  result.grey = grey_noise(dark, grey, channel, result.transfer);
  result.uniformity = non_uniformity(dark, half, channel, result.transfer.dn_per_e);
  return result;
}

}  // namespace petzval
