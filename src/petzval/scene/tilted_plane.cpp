// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/scene/tilted_plane.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// Where the samples of the tilted view look on the scene, both from −1 to 1 across their widths. With t the
/// tangent of the object angle over that of the frame's edge, the depth is d/(1 − steepness t).
struct TiltedView {
  double steepness;  ///< tangent of the tilt × tangent of half the horizontal angle
  double cosine;     ///< of the tilt

  double depth_ratio(double tx) const { return 1 / (1 - steepness * tx); }
  double across(double tx) const { return tx * far_edge() * depth_ratio(tx); }
  double down(double tx, double ty) const { return ty * cosine * far_edge() * depth_ratio(tx); }
  /// So that tx = 1 at the far edge looks at the scene's own edge.
  double far_edge() const { return 1 - std::abs(steepness); }
};

/// Of a band at a place in samples, linear between their middles, the edge's value beyond.
double sampled(std::span<const float> band, int columns, int rows, double x, double y) {
  const auto part = [](double at, int count) {
    const double clamped = std::clamp(at - 0.5, 0.0, count - 1.0);
    const int first = std::min(static_cast<int>(clamped), std::max(0, count - 2));
    return std::pair(first, clamped - first);
  };
  const auto [column, u] = part(x, columns);
  const auto [row, v] = part(y, rows);
  const auto value = [&](int c, int r) {
    return static_cast<double>(
        band[static_cast<std::size_t>(std::min(r, rows - 1)) * static_cast<std::size_t>(columns) +
             static_cast<std::size_t>(std::min(c, columns - 1))]);
  };
  return (1 - v) * ((1 - u) * value(column, row) + u * value(column + 1, row)) +
         v * ((1 - u) * value(column, row + 1) + u * value(column + 1, row + 1));
}

TiltedView view_of(const Scene& scene, double tilt_deg) {
  constexpr double steepest_deg = 80, most_steep = 0.95;
  if (!(std::abs(tilt_deg) < steepest_deg))
    throw InputError(
        fmt::format("`scene.tilt_deg`: a plane tilted by {:g} degrees; less than {:g} would be right",
                    tilt_deg, steepest_deg));
  if (scene.is_panorama() || !scene.depth_m.empty() || !scene.distance_m())
    throw InputError(scene.name,
                     "cannot be tilted; a plane scene without depth at a finite `scene.distance_m` can");
  const TiltedView view{std::tan(radians(tilt_deg)) * std::tan(radians(scene.horizontal_angle_deg()) / 2),
                        std::cos(radians(tilt_deg))};
  if (std::abs(view.steepness) > most_steep)
    throw InputError(
        fmt::format("a plane tilted by {:g} degrees vanishes within a view that is {:.3g} degrees wide; a "
                    "smaller `scene.tilt_deg` would be right",
                    tilt_deg, scene.horizontal_angle_deg()));
  return view;
}

}  // namespace

Scene tilted(const Scene& scene, double tilt_deg) {
  const TiltedView view = view_of(scene, tilt_deg);
  const int columns = scene.columns(), rows = scene.rows();
  Scene result(columns, rows, scene.wavelengths_nm(), scene.horizontal_angle_deg(), scene.distance_m());
  result.name = scene.name, result.illuminant = scene.illuminant, result.notes = scene.notes;
  const auto width = static_cast<std::size_t>(columns);
  const auto tangent = [&](double column) { return 2 * column / columns - 1; };
  // A sample is the mean of as many places as the scene's samples lie close in it: at most so many a side.
  constexpr int most_places = 8;
  const auto places = [&](double column) {
    const double step = columns / 2.0 * (view.across(tangent(column + 1)) - view.across(tangent(column)));
    return std::clamp(static_cast<int>(std::ceil(2 * std::abs(step))), 1, most_places);
  };
  for (int index = 0; index < scene.bands(); ++index) {
    const std::span<const float> from = scene.band(index);
    const std::span<float> to = result.band(index);
    parallel_for(static_cast<std::size_t>(rows), [&](std::size_t row) {
      for (int column = 0; column < columns; ++column) {
        const int n = places(column);
        double sum = 0;
        for (int i = 0; i < n; ++i) {
          const double tx = tangent(column + (i + 0.5) / n);
          for (int j = 0; j < n; ++j) {
            const double ty = 2 * (static_cast<double>(row) + (j + 0.5) / n) / rows - 1;
            sum += sampled(from, columns, rows, (1 + view.across(tx)) * columns / 2,
                           (1 + view.down(tx, ty)) * rows / 2);
          }
        }
        to[row * width + static_cast<std::size_t>(column)] = static_cast<float>(sum / (n * n));
      }
    });
    scene.release_memory(), result.release_memory();
  }
  result.depth_m.resize(result.band_size());
  for (std::size_t i = 0; i < result.depth_m.size(); ++i)
    result.depth_m[i] = static_cast<float>(*scene.distance_m() *
                                           view.depth_ratio(tangent(static_cast<double>(i % width) + 0.5)));
  return result;
}

}  // namespace petzval
