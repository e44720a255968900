// SPDX-License-Identifier: BSD-3-Clause
// Blurred layers, one in front of the other.
#pragma once

#include <petzval/imaging/cell_plane.h>
#include <petzval/imaging/layer_scene.h>

#include <optional>
#include <utility>
#include <vector>

namespace petzval {

/// One band of a layer (LayerScene), imaged.
struct BlurredLayer {
  CellPlane light;
  std::optional<CellPlane> white;    ///< absent: the layer is all of the scene
  std::optional<CellPlane> unknown;  ///< absent: nothing is hidden
  std::optional<CellPlane> share;    ///< absent: it is the farthest
};

/// The image so far, from the farthest layer to the nearest (form_depth_image).
class LayerStack {
 public:
  LayerStack(const SensorGeometry& grid, int bands) : grid_(grid), bands_(static_cast<std::size_t>(bands)) {}

  bool is_empty(int band) const { return !bands_[static_cast<std::size_t>(band)].has_value(); }
  /// Puts a layer in front. \throws InputError if its grid is another.
  void add(int band, BlurredLayer layer);
  /// Of all bands; nothing where there was no layer.
  std::vector<std::optional<CellPlane>> planes() && { return std::move(bands_); }

 private:
  SensorGeometry grid_;
  std::vector<std::optional<CellPlane>> bands_;
};

}  // namespace petzval
