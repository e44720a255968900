// SPDX-License-Identifier: BSD-3-Clause
// A scene with depth as a stack of layers, each at one distance.
#pragma once

#include <petzval/imaging/defocus_law.h>
#include <petzval/scene/scene.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace petzval {

struct DepthOptions {
  int layers = 0;  ///< 1 to 1000; 0: as many as the defocus needs

  /// \throws InputError saying what would be right.
  void validate() const;
};

struct DepthLayer {
  std::optional<double> distance_m;  ///< from the sensor plane; absent: infinity
  double blur_um = 0;                ///< DefocusLaw: signed diameter, positive in front of what is in focus
  double share = 0;                  ///< of the scene's samples
};

struct DepthLayers {
  std::vector<DepthLayer> layers;  ///< from the farthest to the nearest
  /// Where each sample of the scene lies among them: 0 in the farthest layer, n − 1 in the nearest; a sample
  /// at 2.25 belongs to layer 2 by three quarters and to layer 3 by one.
  std::vector<float> place;

  /// How much of a sample belongs to a layer.
  double share(std::size_t sample, std::size_t layer) const {
    return std::max(0.0, 1 - std::abs(double(place[sample]) - double(layer)));
  }
  /// Of a sample, between those of its layers.
  double blur_um(std::size_t sample) const {
    const auto low = static_cast<std::size_t>(place[sample]);
    const std::size_t high = std::min(low + 1, layers.size() - 1);
    return std::lerp(layers[low].blur_um, layers[high].blur_um, double(place[sample]) - double(low));
  }
  /// How much of it lies nearer than the layer, and hides what is there.
  double hiding(std::size_t sample, std::size_t layer) const {
    return std::clamp(double(place[sample]) - double(layer), 0.0, 1.0);
  }
};

/// Depths of a scene from the sensor plane, along the axis [m]; infinite where nothing is.
std::vector<double> axial_depths_m(const Scene& scene, double pupil_to_sensor_mm);

/// tan(half the angle) of a scene as its entrance pupil sees it, over what its plane at its own distance
/// says: 1 for a scene at infinity.
double widening_from_pupil(std::optional<double> distance_m, double pupil_to_sensor_mm);

/// Lays layers through the depths of a scene.
///
/// A map of few different depths (as many as the layers that it would get, or eight) gets a layer for each.
/// Otherwise layers lie in steps of blur: next to each other theirs differ by a pixel, or by an eighth of the
/// blur where it is more than eight pixels; one is in focus if the scene has depths on both sides of it. At
/// most 64, in wider steps, unless more are asked for. Between two layers a sample belongs to both, linearly
/// in blur.
/// \param pixel_um  what a step is. \throws InputError for depths inside the lens, naming the place.
DepthLayers lay_depth_layers(const Scene& scene, const Lens& lens, const DefocusLaw& law, double pixel_um,
                             const DepthOptions& options);

}  // namespace petzval
