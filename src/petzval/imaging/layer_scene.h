// SPDX-License-Identifier: BSD-3-Clause
// One layer of a scene with depth, as planar scenes.
#pragma once

#include <petzval/imaging/depth_layers.h>

#include <cstdint>
#include <vector>

namespace petzval {

/// What of a scene lies in a layer, what is hidden there by what lies nearer, and what may be behind that.
///
/// Each sample of the scene is one line of sight from the entrance pupil. As a planar scene at the distance
/// of the layer, samples lie on the same lines.
class LayerScene {
 public:
  /// What may lie behind nearer things counts as much as this against what is seen: where a kernel finds
  /// both, what is seen decides; where it finds nothing else, it is all that there is. The more it counts,
  /// the less do layers add up to the plane (off by a twentieth of it for a texture); the less, the more do
  /// the negative lobes of kernels (3 % of their peak) against it.
  static constexpr double guess_weight = 0.04;

  /// What is blurred by up to so many pixels more than a layer is taken for the same surface, which goes on
  /// from it: behind such samples lies more of the same.
  static constexpr double same_surface_pixels = 2;

  /// Scene and layers must outlive it. \param pixel_um  of the sensor.
  LayerScene(const Scene& scene, const DepthLayers& layers, std::size_t layer, double pupil_to_sensor_mm,
             double pixel_um);

  std::optional<double> distance_m() const { return layers_.layers[layer_].distance_m; }
  double horizontal_angle_deg() const { return angle_deg_; }
  /// Whether nearer layers hide anything of it.
  bool anything_hidden() const { return !behind_.empty(); }
  /// Whether all of the scene lies in it.
  bool is_everything() const { return everything_; }

  /// A planar scene of the layer's place and width, of one band and without light.
  Scene blank(double wavelength_nm) const;
  /// Radiance of what lies in the layer, and of what the nearest samples that are not hidden show of it.
  Scene light(int band) const;
  /// The same of a white world: how much of each sample lies in the layer.
  Scene share(double wavelength_nm) const;
  /// What nothing is known of: how much of each sample is hidden, less guess_weight of it.
  Scene unknown(double wavelength_nm) const;
  /// White everywhere.
  Scene white(double wavelength_nm) const;

 private:
  void find_behind();
  double weight(std::size_t sample) const { return layers_.share(sample, layer_); }
  /// How much of the layer may be hidden in a sample: what of it is seen in the sample that tells.
  double guess(std::size_t sample) const;

  const Scene& scene_;
  const DepthLayers& layers_;
  std::size_t layer_;
  double same_surface_um_;
  double angle_deg_;
  bool everything_ = true;
  std::vector<std::uint32_t> behind_;  ///< of each sample the one that tells what is there: itself if seen
};

}  // namespace petzval
