// SPDX-License-Identifier: BSD-3-Clause
// What the arithmetic of a surface's shape works with, in double or float, and what it answers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace petzval {

/// How a shape is met by a ray: the first three in closed form, the others by Newton's method.
enum class ShapeForm : std::uint8_t { plane, sphere, conic, powers, even_powers, added };

/// A shape made ready: curvature c, conic constant k, and what a kind has besides.
template <class T>
struct ShapeData {
  ShapeForm form = ShapeForm::plane;
  std::size_t added = 0;  ///< which of AddedShapes, where `form` is added
  T curvature = 0, conic = 0, one_plus_conic = 1;
  /// Of powers of r: Horner coefficients a_p ρ^p in t = r/ρ, or in t = r²/ρ² where all are even. Of an added
  /// kind: what its prepare() made.
  std::vector<T> terms;
  T per_unit = 1;  ///< of powers: 1/ρ or 1/ρ²

  bool is_iterated() const { return form >= ShapeForm::powers; }
};

/// Sag and slopes dz/dx, dz/dy at a place; NaN where there is no surface.
template <class V>
struct SurfacePoint {
  V sag, slope_x, slope_y;
};

}  // namespace petzval
