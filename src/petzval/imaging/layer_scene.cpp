// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/imaging/layer_scene.h>
#include <petzval/imaging/nearest_sample.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// The angle under which the plane of a layer is as wide as the lines of sight through the edges of the scene
/// are apart there.
double layer_angle_deg(const Scene& scene, std::optional<double> distance_m, double pupil_to_sensor_mm) {
  if (distance_m == scene.distance_m()) return scene.horizontal_angle_deg();
  const double widening = widening_from_pupil(scene.distance_m(), pupil_to_sensor_mm) /
                          widening_from_pupil(distance_m, pupil_to_sensor_mm);
  return degrees(2 * std::atan(widening * std::tan(radians(scene.horizontal_angle_deg()) / 2)));
}

}  // namespace

LayerScene::LayerScene(const Scene& scene, const DepthLayers& layers, std::size_t layer,
                       double pupil_to_sensor_mm)
    : scene_(scene),
      layers_(layers),
      layer_(layer),
      angle_deg_(layer_angle_deg(scene, layers.layers[layer].distance_m, pupil_to_sensor_mm)) {
  std::vector<std::uint8_t> seen(layers.place.size());
  bool hidden = false;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const double hiding = layers.hiding(i, layer);
    seen[i] = hiding < 1 ? 1 : 0;
    hidden = hidden || hiding > 0;
    everything_ = everything_ && weight(i) == 1;
  }
  if (!hidden) return;
  behind_ = nearest_samples(scene.columns(), scene.rows(), seen);
}

Scene LayerScene::blank(double wavelength_nm) const {
  return Scene(scene_.columns(), scene_.rows(), {wavelength_nm}, angle_deg_, distance_m());
}

Scene LayerScene::light(int band) const {
  Scene result = blank(scene_.wavelengths_nm()[static_cast<std::size_t>(band)]);
  const std::span<const float> radiance = scene_.band(band);
  const std::span<float> out = result.band(0);
  for (std::size_t i = 0; i < out.size(); ++i) {
    double light = weight(i) * double(radiance[i]);
    if (const double share = guess(i); share > 0) light += share * double(radiance[behind_[i]]);
    out[i] = static_cast<float>(light);
  }
  return result;
}

Scene LayerScene::share(double wavelength_nm) const {
  Scene result = blank(wavelength_nm);
  const std::span<float> out = result.band(0);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<float>(weight(i) + guess(i));
  return result;
}

Scene LayerScene::unknown(double wavelength_nm) const {
  Scene result = blank(wavelength_nm);
  const std::span<float> out = result.band(0);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = static_cast<float>((1 - guess_weight) * layers_.hiding(i, layer_));
  return result;
}

Scene LayerScene::white(double wavelength_nm) const {
  Scene result = blank(wavelength_nm);
  std::fill(result.band(0).begin(), result.band(0).end(), 1.0F);
  return result;
}

}  // namespace petzval
