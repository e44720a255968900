// SPDX-License-Identifier: BSD-3-Clause
// What a chart is made of, finer than any samples.
#pragma once

#include <petzval/scene/shape.h>

#include <memory>
#include <span>
#include <vector>

namespace petzval {

/// Figures of one radiance each on a ground, in a scene's samples as lengths. They do not overlap, so that
/// what they cover of a cell adds up to 1 at most.
struct SceneDrawing {
  struct Figure {
    std::shared_ptr<const Shape> shape;
    std::vector<float> radiance;  ///< by band [W·m⁻²·sr⁻¹·nm⁻¹]
  };
  std::vector<float> ground;  ///< by band [W·m⁻²·sr⁻¹·nm⁻¹]
  /// A factor for the ground in every sample, bilinear between their centres; empty: 1 everywhere.
  std::shared_ptr<const std::vector<float>> texture;
  std::vector<Figure> figures;

  /// Multiplies all radiance, band by band.
  void scale(std::span<const double> factors) {
    const auto by_band = [&](std::vector<float>& radiance) {
      for (std::size_t band = 0; band < radiance.size(); ++band)
        radiance[band] = static_cast<float>(radiance[band] * factors[band]);
    };
    by_band(ground);
    for (Figure& figure : figures) by_band(figure.radiance);
  }
};

}  // namespace petzval
