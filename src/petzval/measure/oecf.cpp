// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/base/whole_file.h>
#include <petzval/measure/colour_chart.h>
#include <petzval/measure/oecf.h>
#include <petzval/measure/viewed_picture.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>

namespace petzval {

namespace {

using Levels = std::vector<double>;

// ISO 15739 and ISO 12232: luminance, and what colour differences weigh beside it.
constexpr double red_weight = 0.2125, green_weight = 0.7154, blue_weight = 0.0721;
constexpr double red_difference_weight = 0.279, blue_difference_weight = 0.088;

double mean_of(const Levels& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double variance_of(const Levels& values) {
  const double mean = mean_of(values);
  double sum = 0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return sum / static_cast<double>(values.size() - 1);
}

/// One patch: [channel][exposure][pixel].
using PatchSamples = std::vector<std::vector<Levels>>;
using TakeSamples = std::function<PatchSamples(const GreyPatch&)>;

/// a R + b G + c B of each pixel and exposure.
std::vector<Levels> mixed(const PatchSamples& rgb, double a, double b, double c) {
  std::vector<Levels> result = rgb[0];
  for (std::size_t k = 0; k < result.size(); ++k)
    for (std::size_t i = 0; i < result[k].size(); ++i)
      result[k][i] = a * rgb[0][k][i] + b * rgb[1][k][i] + c * rgb[2][k][i];
  return result;
}

PatchNoise noise_in_colour(const PatchSamples& rgb) {
  const PatchNoise y = patch_noise(mixed(rgb, red_weight, green_weight, blue_weight));
  const PatchNoise red = patch_noise(mixed(rgb, 1 - red_weight, -green_weight, -blue_weight));
  const PatchNoise blue = patch_noise(mixed(rgb, -red_weight, -green_weight, 1 - blue_weight));
  const auto weighted = [](double of_y, double of_red, double of_blue) {
    return std::sqrt(of_y * of_y + red_difference_weight * of_red * of_red +
                     blue_difference_weight * of_blue * of_blue);
  };
  return {y.mean, weighted(y.temporal, red.temporal, blue.temporal),
          weighted(y.fixed_pattern, red.fixed_pattern, blue.fixed_pattern)};
}

/// The slope at the middle one of three points: of the parabola through them.
double slope_at(const OecfPoint& before, const OecfPoint& at, const OecfPoint& after) {
  const double left = at.patch.exposure - before.patch.exposure,
               right = after.patch.exposure - at.patch.exposure;
  return ((at.noise.mean - before.noise.mean) / left * right +
          (after.noise.mean - at.noise.mean) / right * left) /
         (left + right);
}

void add_gains(std::span<OecfPoint> points) {
  const auto secant = [](const OecfPoint& a, const OecfPoint& b) {
    return (b.noise.mean - a.noise.mean) / (b.patch.exposure - a.patch.exposure);
  };
  const std::size_t last = points.size() - 1;
  points[0].incremental_gain = secant(points[0], points[1]);
  points[last].incremental_gain = secant(points[last - 1], points[last]);
  for (std::size_t i = 1; i < last; ++i)
    points[i].incremental_gain = slope_at(points[i - 1], points[i], points[i + 1]);
}

Oecf evaluated(std::vector<std::string> channels, double white, std::span<const GreyPatch> patches,
               const TakeSamples& take) {
  Oecf oecf{std::move(channels), {}, white, 0, false, 0};
  for (const GreyPatch& patch : patches) {
    const PatchSamples samples = take(patch);
    OecfPoint point{patch, {}, {}, false, 0};
    double brightest = 0;
    for (const std::vector<Levels>& channel : samples) {
      const PatchNoise noise = patch_noise(channel);
      point.levels.push_back(noise.mean);
      constexpr double deviations = 3;
      brightest = std::max(brightest, noise.mean + deviations * noise.total());
    }
    constexpr double as_good_as = 0.995;
    point.clipped = brightest >= as_good_as * white;
    point.noise = samples.size() == 3 ? noise_in_colour(samples) : patch_noise(samples[0]);
    oecf.points.push_back(std::move(point));
  }
  std::ranges::sort(oecf.points, {}, [](const OecfPoint& point) { return point.patch.exposure; });
  for (std::size_t i = 1; i < oecf.points.size(); ++i)
    if (!(oecf.points[i].patch.exposure > oecf.points[i - 1].patch.exposure))
      throw InputError("two patches have one exposure; patches of different exposures would be right");

  const auto first_clipped = std::ranges::find(oecf.points, true, &OecfPoint::clipped);
  const auto unclipped = static_cast<std::size_t>(first_clipped - oecf.points.begin());
  if (unclipped < 2)
    throw InputError("fewer than two patches are not clipped; a shorter exposure would be right");
  add_gains(std::span(oecf.points).first(unclipped));
  const OecfPoint& darkest = oecf.points.front();
  const OecfPoint& brightest = oecf.points[unclipped - 1];
  if (!(darkest.incremental_gain > 0))
    throw InputError(
        "the darkest patches are not told apart; larger ones, or more exposures, would be right");
  oecf.least_exposure = darkest.noise.temporal / darkest.incremental_gain;
  oecf.saturation_exposure = brightest.patch.exposure;
  oecf.saturates = first_clipped != oecf.points.end();
  if (oecf.saturates && brightest.incremental_gain > 0)
    oecf.saturation_exposure =
        std::min(first_clipped->patch.exposure,
                 brightest.patch.exposure +
                     (white - *std::ranges::max_element(brightest.levels)) / brightest.incremental_gain);
  return oecf;
}

void check_patch(const GreyPatch& patch, int columns, int rows) {
  if (patch.x < 0 || patch.y < 0 || patch.width < 1 || patch.height < 1 || patch.x > columns - patch.width ||
      patch.y > rows - patch.height)
    throw InputError(fmt::format("the patch at {}, {} of {} x {} pixels lies outside the picture of {} x {}",
                                 patch.x, patch.y, patch.width, patch.height, columns, rows));
  if (!(patch.exposure >= 0 && std::isfinite(patch.exposure)))
    throw InputError(fmt::format("a patch of exposure {:g}; 0 or more would be right", patch.exposure));
}

}  // namespace

double PatchNoise::total() const {
  return std::hypot(temporal, fixed_pattern);
}

double OecfPoint::snr(double deviation) const {
  return clipped || !(deviation > 0) ? 0 : patch.exposure * incremental_gain / deviation;
}

PatchNoise patch_noise(std::span<const std::vector<double>> exposures) {
  const auto n = static_cast<double>(exposures.size());
  if (n < 2)
    throw InputError("temporal noise shows between exposures; two at least would be right, or eight");
  const std::size_t pixels = exposures[0].size();
  if (pixels < 2) throw InputError("a patch with fewer than two pixels of a channel has no noise to measure");
  Levels mean(pixels);
  for (const Levels& exposure : exposures)
    for (std::size_t i = 0; i < pixels; ++i) mean[i] += exposure[i] / n;
  double differences = 0;
  Levels difference(pixels);
  for (const Levels& exposure : exposures) {
    for (std::size_t i = 0; i < pixels; ++i) difference[i] = exposure[i] - mean[i];
    differences += variance_of(difference) / n;
  }
  const double temporal2 = n / (n - 1) * differences;
  return {mean_of(mean), std::sqrt(temporal2), std::sqrt(std::max(0.0, variance_of(mean) - temporal2 / n))};
}

Oecf measure_oecf(std::span<const RawImage> exposures, int channel, std::span<const GreyPatch> patches) {
  if (exposures.empty()) throw InputError("an OECF needs exposures of a chart; eight would be right");
  const RawImage& first = exposures[0];
  if (channel < 0 || channel >= static_cast<int>(first.channels.size()))
    throw InputError(fmt::format("channel {} of {}", channel, first.channels.size()));
  for (const RawImage& raw : exposures)
    if (raw.columns != first.columns || raw.rows != first.rows || raw.mosaic != first.mosaic ||
        raw.white_level != first.white_level)
      throw InputError("exposures of a chart must have one size, one mosaic and one white level");
  return evaluated({first.channels[static_cast<std::size_t>(channel)]}, first.white_level, patches,
                   [&](const GreyPatch& patch) {
                     check_patch(patch, first.columns, first.rows);
                     PatchSamples samples(1);
                     for (const RawImage& raw : exposures) {
                       Levels values;
                       for (int row = patch.y; row < patch.y + patch.height; ++row)
                         for (int column = patch.x; column < patch.x + patch.width; ++column)
                           if (raw.mosaic.channel(row, column) == channel)
                             values.push_back(raw.pixel(row, column));
                       samples[0].push_back(std::move(values));
                     }
                     return samples;
                   });
}

Oecf measure_oecf(std::span<const ComparablePicture> exposures, std::span<const GreyPatch> patches) {
  if (exposures.empty()) throw InputError("an OECF needs exposures of a chart; eight would be right");
  const ComparablePicture& first = exposures[0];
  if (first.bands != 1 && first.bands != 3)
    throw InputError(fmt::format("a picture of {} channels; grey or RGB would be right", first.bands));
  for (const ComparablePicture& picture : exposures)
    if (picture.columns != first.columns || picture.rows != first.rows || picture.bands != first.bands)
      throw InputError("exposures of a chart must have one size and one number of channels");
  std::vector<std::string> channels{"grey"};
  if (first.bands == 3) channels = {"red", "green", "blue"};
  return evaluated(channels, 1, patches, [&](const GreyPatch& patch) {
    check_patch(patch, first.columns, first.rows);
    PatchSamples samples(first.bands);
    for (std::size_t band = 0; band < first.bands; ++band)
      for (const ComparablePicture& picture : exposures) {
        Levels values;
        for (int row = patch.y; row < patch.y + patch.height; ++row)
          for (int column = patch.x; column < patch.x + patch.width; ++column)
            values.push_back(
                picture.at(band, static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.columns) +
                                     static_cast<std::size_t>(column)));
        samples[band].push_back(std::move(values));
      }
    return samples;
  });
}

std::vector<GreyPatch> colorchecker_greys(const std::string& picture, const Spectrum& light) {
  const ViewedPicture viewed = read_viewed_picture(picture);
  const ChartCorners corners = find_chart(viewed, light);
  const ChartDifference chart = compare_chart(viewed, corners, light);
  const std::vector<Xyz> colours = chart_colours(light);
  const double spacing =
      std::hypot(corners.xy[1][0] - corners.xy[0][0], corners.xy[1][1] - corners.xy[0][1]) /
      (chart_columns - 1);
  constexpr double middle = 0.4;  // of the spacing of patches
  const int side = std::max(2, static_cast<int>(middle * spacing));
  std::vector<GreyPatch> patches;
  for (std::size_t i = chart_columns * (chart_rows - 1); i < chart.patches.size(); ++i)
    patches.push_back({static_cast<int>(std::lround(chart.patches[i].x - side / 2.0)),
                       static_cast<int>(std::lround(chart.patches[i].y - side / 2.0)), side, side,
                       colours[i].y});
  return patches;
}

std::vector<GreyPatch> read_grey_patches(const std::string& path) {
  constexpr std::size_t most_bytes = 1 << 20, columns = 5;
  constexpr std::string_view header = "x_px,y_px,width_px,height_px,exposure";
  std::vector<GreyPatch> patches;
  bool in_table = false;
  for (const TextLine& text : text_lines(read_whole_file(path, most_bytes))) {
    if (trimmed(text.text).empty()) continue;
    if (!in_table && trimmed(text.text) != header)
      throw InputError(path, text.number, fmt::format("the first line is to be {}", header));
    const std::vector<std::string> cells = split_at(text.text, ',');
    if (std::exchange(in_table, true) == false) continue;
    std::vector<double> numbers;
    for (const std::string& cell : cells)
      if (const std::optional<double> number = parse_number(trimmed(cell))) numbers.push_back(*number);
    constexpr double longest_px = 1 << 20;
    if (cells.size() != columns || numbers.size() != columns ||
        std::ranges::any_of(std::span(numbers).first(columns - 1),
                            [](double px) { return !(px >= 0 && px <= longest_px && px == std::floor(px)); }))
      throw InputError(path, text.number,
                       fmt::format("four whole numbers and an exposure, {}, would be right", header));
    patches.push_back({static_cast<int>(numbers[0]), static_cast<int>(numbers[1]),
                       static_cast<int>(numbers[2]), static_cast<int>(numbers[3]), numbers[4]});
  }
  return patches;
}

}  // namespace petzval
