// SPDX-License-Identifier: BSD-3-Clause
// Heights that a surface is lit as if it had.
#pragma once

#include <petzval/render/shapes/geometry.h>

namespace petzval::render {

/// Heights over a surface, in the unit of the scene along its normal. They tilt the shading normal and move
/// nothing (Blinn, Simulation of wrinkled surfaces, SIGGRAPH 1978), and must be small against the radii that
/// the surface bends with. Slopes are differences over Texture::fineness() to both sides.
class BumpMap {
 public:
  explicit BumpMap(FloatTexture height) : height_(std::move(height)), step_(height_->fineness()) {}

  /// The shading normal of a point; unit, on the side of the surface's own. \param along_v  ∂p/∂v.
  Vector3 normal_at(const SurfacePoint& point, Vector3 along_v) const;

 private:
  FloatTexture height_;
  double step_;
};

}  // namespace petzval::render
