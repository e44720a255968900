// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/imaging/depth_layers.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval {

namespace {

constexpr int most_layers = 1000, most_chosen = 64;
/// So many different depths have a layer each, however little their blurs differ.
constexpr std::size_t few_depths = 8;
/// Beyond so many pixels of blur, steps are a share of the blur.
constexpr double even_pixels = 8;

/// Steps of blur, even about the focus and in proportion to the blur beyond: a monotone measure of blur, and
/// its inverse.
double steps_of_blur(double pixels) {
  const double size = std::abs(pixels);
  return std::copysign(size <= even_pixels ? size : even_pixels * (1 + std::log(size / even_pixels)), pixels);
}
double blur_of_steps(double steps) {
  const double size = std::abs(steps);
  return std::copysign(size <= even_pixels ? size : even_pixels * std::exp(size / even_pixels - 1), steps);
}

/// Evenly spaced from one end to the other, in `count` steps.
void add_even(double from, double to, int count, std::vector<double>& marks) {
  for (int i = 1; i <= count; ++i) marks.push_back(i == count ? to : from + (to - from) * i / count);
}

/// Marks in steps of blur from the least to the greatest, one of them at 0 if that lies between.
std::vector<double> even_marks(double least, double greatest, int asked) {
  std::vector<double> marks = {least};
  if (asked == 1) return {(least + greatest) / 2};
  const auto wanted = [](double span) { return static_cast<int>(std::min(1e6, std::ceil(span))); };
  const int most_steps = (asked > 0 ? asked : most_chosen) - 1;
  if (!(least < 0 && greatest > 0) || most_steps < 2) {
    const int steps = asked > 0 ? most_steps : std::clamp(wanted(greatest - least), 1, most_steps);
    add_even(least, greatest, steps, marks);
    return marks;
  }
  int behind = wanted(-least), before = wanted(greatest);
  if (asked > 0 || behind + before > most_steps) {
    behind = std::clamp(static_cast<int>(std::lround(most_steps * -least / (greatest - least))), 1,
                        most_steps - 1);
    before = most_steps - behind;
  }
  add_even(least, 0, behind, marks);
  add_even(0, greatest, before, marks);
  return marks;
}

[[noreturn]] void refuse_near(const Scene& scene, std::size_t sample, double depth_m, const Lens& lens,
                              double nearest_mm) {
  const auto width = static_cast<std::size_t>(scene.columns());
  throw InputError(fmt::format(
      "the depth at row {}, column {} is {:.4g} m from the sensor, but lens {} reaches {:.4g} m in "
      "front of it; `scene.depth_scale` would be right for a map in other units than metres",
      sample / width, sample % width, depth_m, lens.name, nearest_mm / mm_per_m));
}

/// Blur of every sample [µm].
std::vector<double> sample_blurs(const Scene& scene, const Lens& lens, const DefocusLaw& law,
                                 const std::vector<double>& depth_m) {
  const double nearest_mm = std::max(lens.total_track_mm(), law.pupil_to_sensor_mm());
  std::vector<double> blurs;
  blurs.reserve(depth_m.size());
  for (std::size_t i = 0; i < depth_m.size(); ++i) {
    if (!(depth_m[i] * mm_per_m > nearest_mm)) refuse_near(scene, i, depth_m[i], lens, nearest_mm);
    blurs.push_back(law.blur_um(std::isinf(depth_m[i]) ? 0 : law.vergence(depth_m[i])));
  }
  return blurs;
}

/// A layer for each different depth, if there are no more than `most`.
bool lay_by_depth(const std::vector<double>& depth_m, const std::vector<double>& blurs, std::size_t most,
                  std::vector<DepthLayer>& layers) {
  std::vector<std::pair<double, double>> different;  // blur, depth
  for (std::size_t i = 0; i < depth_m.size(); ++i) {
    const std::pair<double, double> here{blurs[i], depth_m[i]};
    const auto at = std::lower_bound(different.begin(), different.end(), here);
    if (at != different.end() && *at == here) continue;
    if (different.size() == most) return false;
    different.insert(at, here);
  }
  for (const auto& [blur, depth] : different)
    layers.push_back({std::isinf(depth) ? std::nullopt : std::optional(depth), blur});
  return true;
}

void lay_by_blur(const std::vector<double>& marks, double pixel_um, const DefocusLaw& law,
                 std::vector<DepthLayer>& layers) {
  for (const double mark : marks) {
    const double blur = blur_of_steps(mark) * pixel_um;
    layers.push_back({law.distance_m(law.vergence_of_blur(blur)), blur});
  }
}

/// A sample that a silhouette runs through has a depth between what is before and what is behind, where
/// nothing is. Along a line of samples it lies, alone or with one other, between two that go on on either
/// side, and is taken to be part of what is before. As it is it would be a bead: a piece of a layer by
/// itself, sharper than what it belongs to; and so it would be on what is behind if that is sharp.
double settled_blur(const std::vector<double>& blurs, std::size_t sample, std::size_t step,
                    std::size_t before, std::size_t behind, double pixel_um) {
  constexpr double least_pixels = 2, going_on = 0.1, least = 0.005;
  const double here = blurs[sample];
  for (const auto& [back, on] : {std::pair<std::size_t, std::size_t>{1, 1}, {1, 2}, {2, 1}}) {
    if (before < back + 1 || behind < on + 1) continue;
    const double first = blurs[sample - back * step], last = blurs[sample + on * step],
                 jump = std::abs(last - first);
    // How far either side goes on from sample to sample: its own samples are no farther off.
    const double of_first = std::abs(blurs[sample - (back + 1) * step] - first),
                 of_last = std::abs(blurs[sample + (on + 1) * step] - last);
    const bool between = (here - first) * (last - here) > 0 &&
                         std::abs(here - first) > 2 * of_first + least * jump &&
                         std::abs(here - last) > 2 * of_last + least * jump;
    if (between && jump > least_pixels * pixel_um && of_first <= going_on * jump &&
        of_last <= going_on * jump)
      return std::max(first, last);  // before the focus blur is positive
  }
  return here;
}

std::vector<double> settled_blurs(const std::vector<double>& blurs, std::size_t columns, double pixel_um) {
  std::vector<double> settled(blurs.size());
  const std::size_t rows = blurs.size() / columns;
  for (std::size_t i = 0; i < blurs.size(); ++i) {
    const std::size_t row = i / columns, column = i % columns;
    settled[i] = settled_blur(blurs, i, 1, column, columns - 1 - column, pixel_um);
    if (settled[i] == blurs[i]) settled[i] = settled_blur(blurs, i, columns, row, rows - 1 - row, pixel_um);
  }
  return settled;
}

void place_samples(const std::vector<double>& blurs, DepthLayers& result) {
  std::vector<DepthLayer>& layers = result.layers;
  for (const double blur : blurs) {
    const auto above = std::upper_bound(layers.begin(), layers.end(), blur,
                                        [](double b, const DepthLayer& layer) { return b < layer.blur_um; });
    double place = double(above - layers.begin()) - 1;
    if (above == layers.begin())
      place = 0;
    else if (above != layers.end())
      place += (blur - std::prev(above)->blur_um) / (above->blur_um - std::prev(above)->blur_um);
    result.place.push_back(static_cast<float>(place));
  }
  for (std::size_t i = 0; i < result.place.size(); ++i) {
    const auto low = static_cast<std::size_t>(result.place[i]);
    const double high_share = double(result.place[i]) - double(low);
    layers[low].share += (1 - high_share) / double(result.place.size());
    if (high_share > 0) layers[low + 1].share += high_share / double(result.place.size());
  }
}

}  // namespace

void DepthOptions::validate() const {
  if (layers < 0 || layers > most_layers)
    throw InputError(fmt::format("{} layers of depth: 1 to {} are right", layers, most_layers));
}

double widening_from_pupil(std::optional<double> distance_m, double pupil_to_sensor_mm) {
  return distance_m ? 1 / (1 - pupil_to_sensor_mm / (*distance_m * mm_per_m)) : 1;
}

std::vector<double> axial_depths_m(const Scene& scene, double pupil_to_sensor_mm) {
  const double pupil_m = scene.depth_from == DepthFrom::sensor ? 0 : pupil_to_sensor_mm / mm_per_m;
  const double tangent =
      scene.tangent_per_sample() * widening_from_pupil(scene.distance_m(), pupil_to_sensor_mm);
  const auto width = static_cast<std::size_t>(scene.columns());
  std::vector<double> depths(scene.depth_m.size());
  for (std::size_t i = 0; i < depths.size(); ++i) {
    double depth = scene.depth_m[i] == 0 ? std::numeric_limits<double>::infinity() : double(scene.depth_m[i]);
    if (scene.depth_from == DepthFrom::range)
      depth /= std::hypot(1.0, tangent * (double(i % width) + 0.5 - scene.columns() / 2.0),
                          tangent * (double(i / width) + 0.5 - scene.rows() / 2.0));
    depths[i] = depth + pupil_m;
  }
  return depths;
}

DepthLayers lay_depth_layers(const Scene& scene, const Lens& lens, const DefocusLaw& law, double pixel_um,
                             const DepthOptions& options) {
  options.validate();
  if (scene.depth_m.empty()) throw InputError(scene.name, "has no depth map");
  const std::vector<double> depth_m = axial_depths_m(scene, law.pupil_to_sensor_mm());
  const std::vector<double> blurs = sample_blurs(scene, lens, law, depth_m);
  const auto [least, greatest] = std::minmax_element(blurs.begin(), blurs.end());
  const std::vector<double> marks =
      even_marks(steps_of_blur(*least / pixel_um), steps_of_blur(*greatest / pixel_um), options.layers);
  DepthLayers result;
  const std::size_t most =
      options.layers > 0 ? static_cast<std::size_t>(options.layers) : std::max(few_depths, marks.size());
  if (!lay_by_depth(depth_m, blurs, most, result.layers)) lay_by_blur(marks, pixel_um, law, result.layers);
  place_samples(settled_blurs(blurs, static_cast<std::size_t>(scene.columns()), pixel_um), result);
  return result;
}

}  // namespace petzval
