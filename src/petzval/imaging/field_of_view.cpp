// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/imaging/field_of_view.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace petzval {

namespace {

SensorGeometry with_margin(SensorGeometry frame, Surround surround) {
  frame.pitch_um *= 1 + margin_of(surround);
  return frame;
}

}  // namespace

std::vector<SceneMap> chief_ray_maps(const Scene& scene, const LensDataTable& table, double half_diagonal_mm,
                                     RadialFit fit) {
  const LightCentres at_chief_rays;
  std::vector<SceneMap> maps;
  for (const double wavelength_nm : scene.wavelengths_nm())
    maps.emplace_back(table, at_chief_rays, fit, wavelength_nm, scene, half_diagonal_mm);
  return maps;
}

SeenExtent seen_extent(const std::vector<SceneMap>& maps, const SensorGeometry& sensor, Surround surround) {
  SeenExtent seen;
  for (const SceneMap& map : maps) seen.include(seen_extent(map, with_margin(sensor, surround)));
  return seen;
}

SeenExtent seen_extent(const Scene& scene, const LensDataTable& table, const SensorGeometry& sensor,
                       const ImagingOptions& options) {
  const double half_diagonal_mm = with_margin(sensor, options.surround).half_diagonal_mm();
  return seen_extent(chief_ray_maps(scene, table, half_diagonal_mm, options.fit), sensor, options.surround);
}

double covering_angle_deg(const Scene& scene, const SeenExtent& seen) {
  const double half_columns = std::max(seen.columns, seen.rows * scene.columns() / scene.rows());
  constexpr double room = 1 + 1e-6;  // so that rounding does not make the scene too small again
  const double angle = degrees(2 * std::atan(room * half_columns * scene.tangent_per_sample()));
  constexpr double widest_deg = 175;
  if (!(angle < widest_deg))
    throw InputError(
        fmt::format("the field of the sensor is {:.1f}° wide: no plane scene covers it; `surround` zero "
                    "or extend and a `scene.horizontal_angle_deg` would do",
                    angle));
  return angle;
}

double covering_angle_deg(const Scene& scene, const LensDataTable& table, const SensorGeometry& sensor,
                          const ImagingOptions& options) {
  return covering_angle_deg(scene, seen_extent(scene, table, sensor, options));
}

double natural_pitch_um(const Scene& scene, const FirstOrder& lens) {
  const double sample_mm = scene.distance_m() ? *scene.distance_m() * mm_per_m * scene.tangent_per_sample() *
                                                    std::abs(lens.magnification)
                                              : std::abs(lens.efl_mm) * scene.tangent_per_sample();
  if (!(sample_mm > 0) || !std::isfinite(sample_mm))
    throw InputError(
        "the lens forms no image of a finite size of this scene: a `sensor` would settle the pixels");
  return sample_mm * um_per_mm;
}

SensorGeometry frame_like(const Scene& scene, int columns, double pitch_um) {
  const double rows = double(columns) * scene.rows() / scene.columns();
  return {columns, std::max(1, static_cast<int>(std::lround(rows))), pitch_um};
}

SensorGeometry largest_covered_frame(const Scene& scene, double pitch_um, const std::vector<SceneMap>& maps,
                                     Surround surround) {
  int fits = 0, too_large = scene.columns() + 1;
  while (too_large - fits > 1) {
    const int middle = fits + (too_large - fits) / 2;
    const SeenExtent seen = seen_extent(maps, frame_like(scene, middle, pitch_um), surround);
    (2 * seen.columns <= scene.columns() && 2 * seen.rows <= scene.rows() ? fits : too_large) = middle;
  }
  if (fits < 1)
    throw InputError(
        fmt::format("the scene, {} × {} samples, is less than a pixel of its own with the light about it: a "
                    "larger `scene.horizontal_angle_deg`, or a `sensor` with `surround` zero or extend, "
                    "would do",
                    scene.columns(), scene.rows()));
  return frame_like(scene, fits, pitch_um);
}

SensorGeometry natural_sensor(const Scene& scene, const LensDataTable& table, const ImagingOptions& options) {
  if (scene.is_panorama())
    throw InputError("a panorama ends nowhere, and so would its image: a `sensor` is needed");
  const double pitch_um = natural_pitch_um(scene, table.first_order);
  const double half_diagonal_mm =
      with_margin(frame_like(scene, scene.columns(), pitch_um), options.surround).half_diagonal_mm();
  return largest_covered_frame(scene, pitch_um, chief_ray_maps(scene, table, half_diagonal_mm, options.fit),
                               options.surround);
}

}  // namespace petzval
