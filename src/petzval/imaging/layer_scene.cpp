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

/// Flags of samples that are not hidden, nor those about them; of those that are not hidden; or of those that
/// are not all hidden: the first of these that are not empty.
template <typename Hiding>
std::vector<std::uint8_t> clearly_seen(int columns, int rows, const Hiding& hiding) {
  const auto width = static_cast<std::size_t>(columns), height = static_cast<std::size_t>(rows);
  std::vector<std::uint8_t> seen(width * height), clear(seen.size(), 0);
  for (std::size_t i = 0; i < seen.size(); ++i) seen[i] = hiding(i) == 0 ? 1 : 0;
  for (std::size_t row = 0; row < height; ++row)
    for (std::size_t column = 0; column < width; ++column) {
      std::uint8_t all = 1;
      for (std::size_t i = row == 0 ? 0 : row - 1; i <= std::min(row + 1, height - 1); ++i)
        for (std::size_t j = column == 0 ? 0 : column - 1; j <= std::min(column + 1, width - 1); ++j)
          all = all & seen[i * width + j];
      clear[row * width + column] = all;
    }
  const auto any = [](const std::vector<std::uint8_t>& flags) {
    return std::find(flags.begin(), flags.end(), 1) != flags.end();
  };
  if (any(clear)) return clear;
  if (!any(seen))
    for (std::size_t i = 0; i < seen.size(); ++i) seen[i] = hiding(i) < 1 ? 1 : 0;
  return seen;
}

}  // namespace

LayerScene::LayerScene(const Scene& scene, const DepthLayers& layers, std::size_t layer,
                       double pupil_to_sensor_mm, double pixel_um)
    : scene_(scene),
      layers_(layers),
      layer_(layer),
      same_surface_um_(same_surface_pixels * pixel_um),
      angle_deg_(layer_angle_deg(scene, layers.layers[layer].distance_m, pupil_to_sensor_mm)) {
  bool hidden = false;
  for (std::size_t i = 0; i < layers.place.size(); ++i) {
    hidden = hidden || layers.hiding(i, layer) > 0;
    everything_ = everything_ && weight(i) == 1;
  }
  if (hidden) find_behind();
}

/// Pictures are mixtures of both sides at edges, and so are many depth maps. What is behind is told by
/// samples that have no hidden ones beside them, if there are such.
void LayerScene::find_behind() {
  const auto hiding = [&](std::size_t sample) { return layers_.hiding(sample, layer_); };
  behind_ =
      nearest_samples(scene_.columns(), scene_.rows(), clearly_seen(scene_.columns(), scene_.rows(), hiding));
  for (std::size_t i = 0; i < behind_.size(); ++i)
    if (hiding(i) < 1 || layers_.blur_um(i) - layers_.layers[layer_].blur_um < same_surface_um_)
      behind_[i] = static_cast<std::uint32_t>(i);
}

double LayerScene::guess(std::size_t sample) const {
  if (!anything_hidden()) return 0;
  const std::size_t like = behind_[sample];
  const double seen = 1 - layers_.hiding(like, layer_);
  return guess_weight * layers_.hiding(sample, layer_) * (seen > 0 ? weight(like) / seen : 1);
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
