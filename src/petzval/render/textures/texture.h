// SPDX-License-Identifier: BSD-3-Clause
// Quantities that vary over a surface.
#pragma once

#include <petzval/render/spectra/lanes.h>
#include <petzval/render/transform.h>

#include <array>
#include <memory>

namespace petzval::render {

/// Where a texture is asked for.
struct TexturePoint {
  Vector3 world;
  double u = 0, v = 0;
  std::array<double, 3> tint{1, 1, 1};  ///< of the vertices: colours of pictures are multiplied by it
};

/// A quantity over a surface: Value is double, or Lanes for the wavelengths of `group`.
template <class Value>
class Texture {
 public:
  virtual ~Texture() = default;
  virtual Value at(const TexturePoint& point, int group) const = 0;
  /// Whether it is the same everywhere.
  virtual bool is_constant() const { return false; }
  /// A step in u and v over which its slopes are told; as in pbrt-v4 if nothing better is known.
  virtual double fineness() const { return 5e-4; }
};

using FloatTexture = std::shared_ptr<const Texture<double>>;
using SpectrumTexture = std::shared_ptr<const Texture<Lanes>>;

/// How a place on a surface becomes texture coordinates (s, t).
struct TextureMapping {
  enum class Kind { uv, planar, spherical, cylindrical };
  Kind kind = Kind::uv;
  double scale_u = 1, scale_v = 1, offset_u = 0, offset_v = 0;
  double s_from_v = 0, t_from_u = 0;  ///< of pictures that are turned
  Vector3 axis_s{1, 0, 0}, axis_t{0, 1, 0};
  Transform texture_from_world;

  void coordinates(const TexturePoint& point, double& s, double& t) const;
};

}  // namespace petzval::render
