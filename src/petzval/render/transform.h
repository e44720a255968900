// SPDX-License-Identifier: BSD-3-Clause
// Affine maps between the coordinate systems of a scene.
#pragma once

#include <petzval/render/vector3.h>

#include <array>

namespace petzval::render {

/// A 4 × 4 matrix acting on columns: row-major, m[row][column].
using Matrix4 = std::array<std::array<double, 4>, 4>;

/// A map with its inverse. Named by what it gives: world_from_object.point(p).
class Transform {
 public:
  Transform() = default;  ///< identity
  /// \throws InputError (without place) if the matrix cannot be inverted or is not finite.
  explicit Transform(const Matrix4& matrix);

  static Transform translation(Vector3 by);
  static Transform scaling(Vector3 by);
  static Transform rotation(double degrees, Vector3 axis);
  /// pbrt's LookAt: camera from world, the camera looking along +z with +y up and +x to the right.
  static Transform look_at(Vector3 eye, Vector3 target, Vector3 up);

  Vector3 point(Vector3 p) const;
  Vector3 direction(Vector3 v) const;
  /// By the transposed inverse; not of unit length.
  Vector3 normal(Vector3 n) const;

  /// As inverse().point(p) and inverse().direction(v), without a copy.
  Vector3 inverse_point(Vector3 p) const;
  Vector3 inverse_direction(Vector3 v) const;

  Transform inverse() const;
  /// First `b`, then `a`.
  friend Transform operator*(const Transform& a, const Transform& b);
  bool swaps_handedness() const;
  bool is_affine() const;
  const Matrix4& matrix() const { return matrix_; }
  const Matrix4& inverse_matrix() const { return inverse_; }

 private:
  Transform(const Matrix4& matrix, const Matrix4& inverse) : matrix_(matrix), inverse_(inverse) {}
  static constexpr Matrix4 identity{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};

  Matrix4 matrix_ = identity, inverse_ = identity;
};

}  // namespace petzval::render
