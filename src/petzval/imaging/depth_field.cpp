// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/imaging/depth_field.h>
#include <petzval/imaging/layer_plan.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// The plans of both ends, for frames up to this one.
std::vector<BandPlan> plan_ends(const Scene& scene, const DepthCamera& camera, const SensorGeometry& sensor,
                                const ImagingOptions& options, const DepthOptions& depth) {
  const DefocusLaw law(camera.lens);
  const DepthLayers layers = lay_depth_layers(scene, camera.lens, law, sensor.pitch_um, depth);
  std::vector<BandPlan> plans;
  for (const std::size_t end : {layers.layers.size() - 1, std::size_t{0}}) {
    const LensDataTable table = layer_table(camera, layers, end, sensor.pitch_um);
    const LayerScene layer(scene, layers, end, law.pupil_to_sensor_mm(), sensor.pitch_um);
    for (BandPlan& plan : plan_layer(scene, layer, table, options.cells_of(sensor), options))
      plans.push_back(std::move(plan));
    if (layers.layers.size() == 1) break;
  }
  return plans;
}

/// tan(object angle) from one sample to the next, seen from the entrance pupil.
double tangent_from_pupil(const Scene& scene, const DefocusLaw& law) {
  return scene.tangent_per_sample() * widening_from_pupil(scene.distance_m(), law.pupil_to_sensor_mm());
}

}  // namespace

double natural_depth_pitch_um(const Scene& scene, const Lens& lens) {
  const DefocusLaw law(lens);
  // The height at the sensor of the chief ray of a small angle, through the middle of the pupil.
  const FirstOrder first = first_order(lens);
  const double height_mm =
      trace_paraxial(lens, -first.entrance_pupil.position_mm, 1, lens.reference_wavelength_nm)
          .height_mm.back();
  const double pitch_um = std::abs(height_mm) * tangent_from_pupil(scene, law) * um_per_mm;
  if (!(pitch_um > 0) || !std::isfinite(pitch_um))
    throw InputError(
        "the lens forms no image of a finite size of this scene: a --sensor would settle the pixels");
  return pitch_um;
}

double covering_depth_angle_deg(const Scene& scene, const DepthCamera& camera, const SensorGeometry& sensor,
                                const ImagingOptions& options, const DepthOptions& depth) {
  const SeenExtent seen =
      seen_extent(plan_ends(scene, camera, sensor, options, depth), options.cells_of(sensor));
  const double half_columns = std::max(seen.columns, seen.rows * scene.columns() / scene.rows());
  constexpr double room = 1 + 1e-6;  // so that rounding does not make the scene too small again
  const double angle = degrees(2 * std::atan(room * half_columns * scene.tangent_per_sample()));
  constexpr double widest_deg = 175;
  if (!(angle < widest_deg))
    throw InputError(
        fmt::format("the field of the sensor is {:.1f}° wide: no plane scene covers it; --surround zero "
                    "or extend and a --scene-angle would do",
                    angle));
  return angle;
}

SensorGeometry natural_depth_sensor(const Scene& scene, const DepthCamera& camera,
                                    const ImagingOptions& options, const DepthOptions& depth) {
  const double pitch_um = natural_depth_pitch_um(scene, camera.lens);
  const auto frame_of = [&](int columns) {
    const double rows = double(columns) * scene.rows() / scene.columns();
    return SensorGeometry{columns, std::max(1, static_cast<int>(std::lround(rows))), pitch_um};
  };
  const std::vector<BandPlan> plans = plan_ends(scene, camera, frame_of(scene.columns()), options, depth);
  int fits = 0, too_large = scene.columns() + 1;
  while (too_large - fits > 1) {
    const int middle = fits + (too_large - fits) / 2;
    const SeenExtent seen = seen_extent(plans, options.cells_of(frame_of(middle)));
    (2 * seen.columns <= scene.columns() && 2 * seen.rows <= scene.rows() ? fits : too_large) = middle;
  }
  if (fits < 1)
    throw InputError(
        fmt::format("the blur alone is larger than the image of the scene, {} × {} pixels of {:.4g} µm: "
                    "a --sensor with --surround extend would do",
                    scene.columns(), scene.rows(), pitch_um));
  return frame_of(fits);
}

}  // namespace petzval
