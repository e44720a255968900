// SPDX-License-Identifier: BSD-3-Clause
// The operations that shapes are written in, for vectors of rays, for plain numbers and for numbers with a
// derivative. + - * / are those of C++. Included once per instruction set.
#if defined(PETZVAL_LENS_SHAPES_NUMBERS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PETZVAL_LENS_SHAPES_NUMBERS_INL_H_
#undef PETZVAL_LENS_SHAPES_NUMBERS_INL_H_
#else
#define PETZVAL_LENS_SHAPES_NUMBERS_INL_H_
#endif

#include <hwy/highway.h>

#include <cmath>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// A number and its derivative; of Dual numbers again for higher ones, with several slopes for derivatives by
/// several things at once.
template <class T, class S = T>
struct Dual {
  T value;
  S slope;

  friend Dual operator+(const Dual& a, const Dual& b) { return {a.value + b.value, a.slope + b.slope}; }
  friend Dual operator-(const Dual& a, const Dual& b) { return {a.value - b.value, a.slope - b.slope}; }
  friend Dual operator*(const Dual& a, const Dual& b) {
    return {a.value * b.value, a.slope * b.value + a.value * b.slope};
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const T ratio = a.value / b.value;
    return {ratio, (a.slope - ratio * b.slope) / b.value};
  }
};

template <class V>
struct IsDual : std::false_type {};
template <class T, class S>
struct IsDual<Dual<T, S>> : std::true_type {};

/// One number, as against a vector of them.
template <class V>
concept SingleNumber = std::is_floating_point_v<V> || IsDual<V>::value;

/// A number that is the same for all rays.
template <class V>
HWY_INLINE V constant(double value) {
  if constexpr (std::is_floating_point_v<V>)
    return static_cast<V>(value);
  else if constexpr (IsDual<V>::value)
    return {constant<decltype(V::value)>(value), {}};
  else
    return hn::Set(hn::DFromV<V>(), static_cast<hn::TFromV<V>>(value));
}

/// One that is the same for all rays and has a derivative already.
template <class V>
requires IsDual<V>::value HWY_INLINE V constant(const V& value) {
  return value;
}

template <class V>
HWY_INLINE V square_root(V a) {
  if constexpr (std::is_floating_point_v<V>) {
    return std::sqrt(a);
  } else if constexpr (IsDual<V>::value) {
    const auto root = square_root(a.value);
    return {root, a.slope / (root + root)};
  } else {
    return hn::Sqrt(a);
  }
}

template <class V>
HWY_INLINE V negative(V a) {
  if constexpr (std::is_floating_point_v<V>)
    return -a;
  else
    return hn::Neg(a);
}

/// a·b + c, in one rounding where vectors have that.
template <class V>
HWY_INLINE V mul_add(V a, V b, V c) {
  if constexpr (SingleNumber<V>)
    return a * b + c;
  else
    return hn::MulAdd(a, b, c);
}
/// a·b − c
template <class V>
HWY_INLINE V mul_sub(V a, V b, V c) {
  if constexpr (SingleNumber<V>)
    return a * b - c;
  else
    return hn::MulSub(a, b, c);
}
/// c − a·b
template <class V>
HWY_INLINE V neg_mul_add(V a, V b, V c) {
  if constexpr (SingleNumber<V>)
    return c - a * b;
  else
    return hn::NegMulAdd(a, b, c);
}
// Orders of evaluation: single numbers go from left to right, vectors as fused operations have it.

/// a·b + c·d + e
template <class V>
HWY_INLINE V dot_add(V a, V b, V c, V d, V e) {
  if constexpr (SingleNumber<V>)
    return a * b + c * d + e;
  else
    return hn::MulAdd(a, b, hn::MulAdd(c, d, e));
}

/// a·b·c: single numbers from left to right, vectors a·c first.
template <class V>
HWY_INLINE V product(V a, V b, V c) {
  if constexpr (SingleNumber<V>)
    return a * b * c;
  else
    return a * c * b;
}
/// a·b² + c
template <class V>
HWY_INLINE V square_mul_add(V a, V b, V c) {
  if constexpr (SingleNumber<V>)
    return a * b * b + c;
  else
    return hn::MulAdd(a, b * b, c);
}
/// a·b/c + d
template <class V>
HWY_INLINE V mul_div_add(V a, V b, V c, V d) {
  if constexpr (SingleNumber<V>)
    return a * b / c + d;
  else
    return hn::MulAdd(a, b / c, d);
}

// Comparisons give a bool, or a mask of lanes.
template <class V>
HWY_INLINE auto is_below(V a, V b) {
  if constexpr (std::is_floating_point_v<V>)
    return a < b;
  else
    return hn::Lt(a, b);
}
template <class V>
HWY_INLINE auto is_number(V a) {
  if constexpr (std::is_floating_point_v<V>)
    return a == a;  // NOLINT(misc-redundant-expression): false for NaN alone, as below
  else
    return hn::Eq(a, a);
}
template <class M, class V>
HWY_INLINE V choose(M which, V yes, V no) {
  if constexpr (std::is_floating_point_v<V>)
    return which ? yes : no;
  else
    return hn::IfThenElse(which, yes, no);
}
/// a/b or c/d
template <class M, class V>
HWY_INLINE V choose_ratio(M which, V a, V b, V c, V d) {
  if constexpr (std::is_floating_point_v<V>)
    return which ? a / b : c / d;
  else
    return hn::IfThenElse(which, a, c) / hn::IfThenElse(which, b, d);
}
/// The larger of two; `floor` where a derivative has none.
template <class V>
HWY_INLINE V at_least(V a, V floor) {
  if constexpr (std::is_floating_point_v<V>)
    return a > floor ? a : floor;
  else if constexpr (IsDual<V>::value)
    return {at_least(a.value, floor.value), a.slope};
  else
    return hn::Max(a, floor);
}
template <class V>
HWY_INLINE V magnitude(V a) {
  if constexpr (std::is_floating_point_v<V>)
    return std::abs(a);
  else
    return hn::Abs(a);
}

}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // PETZVAL_LENS_SHAPES_NUMBERS_INL_H_
