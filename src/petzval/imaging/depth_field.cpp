// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/imaging/depth_field.h>
#include <petzval/imaging/field_of_view.h>
#include <petzval/imaging/layer_plan.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// chief_ray_maps() of both ends, for frames up to this one.
std::vector<SceneMap> maps_of_ends(const Scene& scene, const DepthCamera& camera,
                                   const SensorGeometry& sensor, const ImagingOptions& options,
                                   const DepthOptions& depth) {
  const DefocusLaw law(camera.lens);
  const DepthLayers layers = lay_depth_layers(scene, camera.lens, law, sensor.pitch_um, depth);
  const double half_diagonal_mm = (1 + margin_of(options.surround)) * sensor.half_diagonal_mm();
  std::vector<SceneMap> maps;
  for (const std::size_t end : {layers.layers.size() - 1, std::size_t{0}}) {
    LensDataTable table = layer_table(camera, layers, end, sensor.pitch_um, options.product.tolerance);
    const LayerScene layer(scene, layers, end, law.pupil_to_sensor_mm(), sensor.pitch_um);
    for (const double wavelength_nm : scene.wavelengths_nm())
      maps.push_back(std::move(
          chief_ray_maps(layer.blank(wavelength_nm), table, half_diagonal_mm, options.fit).front()));
    keep_layer_table(camera, layers, end, sensor.pitch_um, std::move(table));
    if (layers.layers.size() == 1) break;
  }
  return maps;
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
        "the lens forms no image of a finite size of this scene: a `sensor` would settle the pixels");
  return pitch_um;
}

double covering_depth_angle_deg(const Scene& scene, const DepthCamera& camera, const SensorGeometry& sensor,
                                const ImagingOptions& options, const DepthOptions& depth) {
  return covering_angle_deg(
      scene, seen_extent(maps_of_ends(scene, camera, sensor, options, depth), sensor, options.surround));
}

SensorGeometry natural_depth_sensor(const Scene& scene, const DepthCamera& camera,
                                    const ImagingOptions& options, const DepthOptions& depth) {
  const double pitch_um = natural_depth_pitch_um(scene, camera.lens);
  const SensorGeometry whole = frame_like(scene, scene.columns(), pitch_um);
  return largest_covered_frame(scene, pitch_um, maps_of_ends(scene, camera, whole, options, depth),
                               options.surround);
}

}  // namespace petzval
