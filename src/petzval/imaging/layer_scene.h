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
  /// the less do layers add up to the plane (2e-3 of a texture at 0.1, 1e-3 at 0.05); the less, the more do
  /// the negative lobes of kernels (3 % of their peak) against it.
  static constexpr double guess_weight = 0.05;

  /// Scene and layers must outlive it.
  LayerScene(const Scene& scene, const DepthLayers& layers, std::size_t layer, double pupil_to_sensor_mm);

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
  double weight(std::size_t sample) const { return layers_.share(sample, layer_); }
  /// How much of the layer may be hidden in a sample: what of it is seen in the nearest sample that is not
  /// all hidden, itself if it is one.
  double guess(std::size_t sample) const {
    if (!anything_hidden()) return 0;
    const std::size_t like = behind_[sample];
    return guess_weight * layers_.hiding(sample, layer_) * weight(like) / (1 - layers_.hiding(like, layer_));
  }

  const Scene& scene_;
  const DepthLayers& layers_;
  std::size_t layer_;
  double angle_deg_;
  bool everything_ = true;
  std::vector<std::uint32_t> behind_;  ///< of each sample the nearest that is not all hidden
};

}  // namespace petzval
