// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/imaging/band_plan.h>
#include <petzval/imaging/field_of_view.h>
#include <petzval/imaging/psf_tails.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace petzval {

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
  const SensorGeometry frame = options.cells_of(sensor);
  const std::optional<TailSplit> split = split_table(table, sensor, options);
  return covering_angle_deg(
      scene, seen_extent(plan_bands(scene, split ? split->sharp : table, frame, options), frame));
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

std::optional<SensorGeometry> largest_covered_frame(const Scene& scene, double pitch_um,
                                                    const std::vector<BandPlan>& plans,
                                                    const ImagingOptions& options) {
  int fits = 0, too_large = scene.columns() + 1;
  while (too_large - fits > 1) {
    const int middle = fits + (too_large - fits) / 2;
    const SeenExtent seen = seen_extent(plans, options.cells_of(frame_like(scene, middle, pitch_um)));
    (2 * seen.columns <= scene.columns() && 2 * seen.rows <= scene.rows() ? fits : too_large) = middle;
  }
  if (fits < 1) return {};
  return frame_like(scene, fits, pitch_um);
}

SensorGeometry natural_sensor(const Scene& scene, const LensDataTable& table, const ImagingOptions& options) {
  if (scene.is_panorama())
    throw InputError("a panorama ends nowhere, and so would its image: a `sensor` is needed");
  const double pitch_um = natural_pitch_um(scene, table.first_order);
  const SensorGeometry whole = frame_like(scene, scene.columns(), pitch_um);
  const std::optional<TailSplit> split = split_table(table, whole, options);
  const auto frame = largest_covered_frame(
      scene, pitch_um, plan_bands(scene, split ? split->sharp : table, options.cells_of(whole), options),
      options);
  if (!frame)
    throw InputError(
        fmt::format("the PSF alone is larger than the image of the scene, {} × {} pixels of {:.4g} µm: a "
                    "larger `scene.horizontal_angle_deg` or a `sensor` would do",
                    scene.columns(), scene.rows(), pitch_um));
  return *frame;
}

}  // namespace petzval
