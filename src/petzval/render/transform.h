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

  Vector3 point(Vector3 p) const { return mapped_point(matrix_, p); }
  Vector3 direction(Vector3 v) const { return mapped_direction(matrix_, v); }
  /// By the transposed inverse; not of unit length.
  Vector3 normal(Vector3 n) const {
    const auto& m = inverse_;
    return {m[0][0] * n.x + m[1][0] * n.y + m[2][0] * n.z, m[0][1] * n.x + m[1][1] * n.y + m[2][1] * n.z,
            m[0][2] * n.x + m[1][2] * n.y + m[2][2] * n.z};
  }

  /// As inverse().point(p) and inverse().direction(v), without a copy.
  Vector3 inverse_point(Vector3 p) const { return mapped_point(inverse_, p); }
  Vector3 inverse_direction(Vector3 v) const { return mapped_direction(inverse_, v); }

  /// On the way from `a` to `b`: translations and scales go straight, rotations on the shortest arc (polar
  /// decomposition; Shoemake and Duff 1992). \param share  of the way, 0 to 1. \throws InputError (without
  /// place) for maps that are not affine or become singular on the way.
  static Transform between(const Transform& a, const Transform& b, double share);

  Transform inverse() const;
  /// First `b`, then `a`.
  friend Transform operator*(const Transform& a, const Transform& b);
  bool swaps_handedness() const;
  bool is_affine() const;
  const Matrix4& matrix() const { return matrix_; }
  const Matrix4& inverse_matrix() const { return inverse_; }

 private:
  static Vector3 mapped_point(const Matrix4& m, Vector3 p) {
    const double w = m[3][0] * p.x + m[3][1] * p.y + m[3][2] * p.z + m[3][3];
    const Vector3 q{m[0][0] * p.x + m[0][1] * p.y + m[0][2] * p.z + m[0][3],
                    m[1][0] * p.x + m[1][1] * p.y + m[1][2] * p.z + m[1][3],
                    m[2][0] * p.x + m[2][1] * p.y + m[2][2] * p.z + m[2][3]};
    return w == 1 ? q : (1 / w) * q;
  }
  static Vector3 mapped_direction(const Matrix4& m, Vector3 v) {
    return {m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z, m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
            m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z};
  }
  Transform(const Matrix4& matrix, const Matrix4& inverse) : matrix_(matrix), inverse_(inverse) {}
  static constexpr Matrix4 identity{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};

  Matrix4 matrix_ = identity, inverse_ = identity;
};

}  // namespace petzval::render
