// SPDX-License-Identifier: BSD-3-Clause
// Pictures that say how a surface leans.
#pragma once

#include <petzval/render/shapes/geometry.h>
#include <petzval/render/textures/picture_texture.h>

namespace petzval::render {

/// A picture of normals in the frame of the surface: red along ∂p/∂u, green along the direction across, blue
/// along the shading normal, each 2 × value − 1.
class NormalMap {
 public:
  /// \param scale  of the first two. \param towards_v  green is on the side of ∂p/∂v (glTF), else of normal ×
  /// ∂p/∂u (pbrt-v4): not the same where a picture lies mirrored on a surface.
  NormalMap(PictureSampler picture, TextureMapping mapping, double scale, bool towards_v)
      : picture_(std::move(picture)), mapping_(std::move(mapping)), scale_(scale), towards_v_(towards_v) {}

  /// The shading normal of a point as the picture has it; unit, on the side of the surface's own.
  Vector3 normal_at(const SurfacePoint& point) const;

 private:
  PictureSampler picture_;
  TextureMapping mapping_;
  double scale_;
  bool towards_v_;
};

}  // namespace petzval::render
