// SPDX-License-Identifier: BSD-3-Clause
// Points and directions of a three-dimensional scene.
#pragma once

#include <cmath>

namespace petzval::render {

/// A point, a direction or a normal; which of them, its name says.
struct Vector3 {
  double x = 0, y = 0, z = 0;

  friend Vector3 operator+(Vector3 a, Vector3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vector3 operator-(Vector3 a, Vector3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vector3 operator-(Vector3 a) { return {-a.x, -a.y, -a.z}; }
  friend Vector3 operator*(double s, Vector3 a) { return {s * a.x, s * a.y, s * a.z}; }
};

inline double dot(Vector3 a, Vector3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vector3 cross(Vector3 a, Vector3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Vector3 a) {
  return std::sqrt(dot(a, a));
}
/// The zero vector stays what it is.
inline Vector3 normalised(Vector3 a) {
  const double l = length(a);
  return l > 0 ? (1 / l) * a : a;
}
/// `a`, or −a, whichever lies on the side of `b`.
inline Vector3 facing(Vector3 a, Vector3 b) {
  return dot(a, b) < 0 ? -a : a;
}
inline bool is_finite(Vector3 a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

/// Two directions at right angles to the unit vector z and to each other; with z they are a frame.
struct Frame {
  Vector3 x, y, z;

  /// (Duff et al., "Building an orthonormal basis, revisited", JCGT 6 (2017) 1.)
  explicit Frame(Vector3 unit) : z(unit) {
    const double sign = std::copysign(1.0, z.z), a = -1 / (sign + z.z), b = z.x * z.y * a;
    x = {1 + sign * z.x * z.x * a, sign * b, -sign * z.x};
    y = {b, sign + z.y * z.y * a, -z.y};
  }
  /// With x along `along` as far as that is at right angles to z.
  Frame(Vector3 unit, Vector3 along) : Frame(unit) {
    const Vector3 flat = along - dot(along, unit) * unit;
    if (!(dot(flat, flat) > 1e-24 * dot(along, along))) return;
    x = normalised(flat);
    y = cross(z, x);
  }
  Vector3 to_local(Vector3 v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
  Vector3 from_local(Vector3 v) const { return v.x * x + v.y * y + v.z * z; }
};

}  // namespace petzval::render
