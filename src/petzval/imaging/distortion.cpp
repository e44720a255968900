// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/imaging/distortion.h>
#include <petzval/imaging/frame_look.h>
#include <petzval/imaging/height_look.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

std::shared_ptr<const SceneLook> look_of(const LensDataTable& table, const LightCentres& centres,
                                         RadialFit fit, double wavelength_nm, const Scene& scene,
                                         double largest_height_mm) {
  if (table.frame) {
    if (fit.polynomial_order != 0)
      throw InputError(
          "polynomials over field height do not fit a table over the frame; `fit` monotone does");
    return std::make_shared<FrameLook>(table, centres, wavelength_nm, scene);
  }
  const LightProfile lens(RadialProfiles(table, fit).at_wavelength(wavelength_nm), table, centres,
                          wavelength_nm);
  return std::make_shared<HeightLook>(lens, object_to_sensor_mm(table), scene, largest_height_mm);
}

}  // namespace

double scene_radius(double field, std::optional<double> object_to_sensor_mm, const Scene& scene) {
  if (scene.is_panorama()) return radians(field) / scene.tangent_per_sample();
  if (object_to_sensor_mm) return field / (*object_to_sensor_mm * scene.tangent_per_sample());
  constexpr double widest_deg = 89.999;  // a plane cannot fill half of space: from here on, beyond any scene
  return std::tan(radians(std::min(field, widest_deg))) / scene.tangent_per_sample();
}

std::optional<double> object_to_sensor_mm(const LensDataTable& table) {
  if (!table.object_distance_mm) return std::nullopt;
  return *table.object_distance_mm + table.vertex_to_sensor_mm;
}

SceneMap::SceneMap(const LightProfile& lens, std::optional<double> object_to_sensor_mm, const Scene& scene,
                   double largest_height_mm)
    : SceneMap(std::make_shared<HeightLook>(lens, object_to_sensor_mm, scene, largest_height_mm)) {}

SceneMap::SceneMap(const LensDataTable& table, const LightCentres& centres, RadialFit fit,
                   double wavelength_nm, const Scene& scene, double largest_height_mm)
    : SceneMap(look_of(table, centres, fit, wavelength_nm, scene, largest_height_mm)) {}

}  // namespace petzval
