// SPDX-License-Identifier: BSD-3-Clause
// The arithmetic of poses, for plain numbers and for numbers with derivatives.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>

namespace petzval {

template <class T>
using VectorOf = std::array<T, 3>;
template <class T>
using RowsOf = std::array<VectorOf<T>, 3>;

inline double sine(double angle) {
  return std::sin(angle);
}
inline double cosine(double angle) {
  return std::cos(angle);
}

/// A number without derivatives.
template <class T>
T plain(double value) {
  if constexpr (std::is_floating_point_v<T>)
    return value;
  else
    return {value, {}};
}

template <class T>
RowsOf<T> product(const RowsOf<T>& a, const RowsOf<T>& b) {
  RowsOf<T> result{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t j = 0; j < 3; ++j) result[i][k] = result[i][k] + a[i][j] * b[j][k];
  return result;
}

template <class T>
VectorOf<T> product(const RowsOf<T>& a, const VectorOf<T>& v) {
  VectorOf<T> result{};
  for (std::size_t i = 0; i < 3; ++i) result[i] = a[i][0] * v[0] + a[i][1] * v[1] + a[i][2] * v[2];
  return result;
}

/// The transpose of `a` times v.
template <class T>
VectorOf<T> transposed_product(const RowsOf<T>& a, const VectorOf<T>& v) {
  VectorOf<T> result{};
  for (std::size_t i = 0; i < 3; ++i) result[i] = a[0][i] * v[0] + a[1][i] * v[1] + a[2][i] * v[2];
  return result;
}

/// Turns about the axes, angles in radians.
template <class T>
RowsOf<T> about_x(const T& angle) {
  const T c = cosine(angle), s = sine(angle), o = plain<T>(0), e = plain<T>(1);
  return {{{e, o, o}, {o, c, o - s}, {o, s, c}}};
}
template <class T>
RowsOf<T> about_y(const T& angle) {
  const T c = cosine(angle), s = sine(angle), o = plain<T>(0), e = plain<T>(1);
  return {{{c, o, s}, {o, e, o}, {o - s, o, c}}};
}
template <class T>
RowsOf<T> about_z(const T& angle) {
  const T c = cosine(angle), s = sine(angle), o = plain<T>(0), e = plain<T>(1);
  return {{{c, o - s, o}, {s, c, o}, {o, o, e}}};
}

/// A Frame (lens/pose.h) whose numbers may have derivatives.
template <class T>
struct FrameOf {
  VectorOf<T> offset_mm{};
  RowsOf<T> rows{{{plain<T>(1), plain<T>(0), plain<T>(0)},
                  {plain<T>(0), plain<T>(1), plain<T>(0)},
                  {plain<T>(0), plain<T>(0), plain<T>(1)}}};
};

/// A Pose as how far it moves [mm] and how far it then turns about x, y and z [rad].
template <class T>
struct Motion {
  VectorOf<T> shift_mm, turn;

  RowsOf<T> rows() const { return product(about_x(turn[0]), product(about_y(turn[1]), about_z(turn[2]))); }
};

/// Moves a frame, whose vertex the prescription has `from_pivot_mm` behind the pivot.
template <class T>
void move(const Motion<T>& motion, const T& from_pivot_mm, FrameOf<T>& frame) {
  const RowsOf<T> rows = motion.rows();
  const VectorOf<T> arm =
      product(rows, VectorOf<T>{frame.offset_mm[0], frame.offset_mm[1], frame.offset_mm[2] + from_pivot_mm});
  for (std::size_t i = 0; i < 3; ++i) frame.offset_mm[i] = arm[i] + motion.shift_mm[i];
  frame.offset_mm[2] = frame.offset_mm[2] - from_pivot_mm;
  frame.rows = product(rows, frame.rows);
}

}  // namespace petzval
