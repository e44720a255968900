// SPDX-License-Identifier: BSD-3-Clause
// Conics, and powers of r on them. Included once per instruction set.
#if defined(PETZVAL_LENS_SHAPES_POWERS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PETZVAL_LENS_SHAPES_POWERS_INL_H_
#undef PETZVAL_LENS_SHAPES_POWERS_INL_H_
#else
#define PETZVAL_LENS_SHAPES_POWERS_INL_H_
#endif

#include <petzval/lens/shapes/numbers-inl.h>
#include <petzval/lens/shapes/shape_data.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {

/// A round departure from the conic of c and k. \param rise, rise_over_r  the departure at r, and its slope
/// divided by r.
template <class V, class T>
HWY_INLINE SurfacePoint<V> on_conic(const ShapeData<T>& shape, V x, V y, V r_sq, V rise, V rise_over_r) {
  const V c = constant<V>(shape.curvature), one = constant<V>(1);
  const V q_c_sq = constant<V>(shape.one_plus_conic * shape.curvature * shape.curvature);
  const V root = square_root(neg_mul_add(q_c_sq, r_sq, one));  // NaN beyond the rim
  const V slope_over_r = c / root + rise_over_r;
  return {mul_div_add(c, r_sq, one + root, rise), slope_over_r * x, slope_over_r * y};
}

struct Conic {
  template <class V, class T>
  static HWY_INLINE SurfacePoint<V> at(const ShapeData<T>& shape, V x, V y) {
    const V zero = constant<V>(0);
    return on_conic(shape, x, y, mul_add(x, x, y * y), zero, zero);
  }
};

/// Σ a_p r^p, by Horner together with its slope.
template <bool even>
struct Powers {
  template <class V, class T>
  static HWY_INLINE SurfacePoint<V> at(const ShapeData<T>& shape, V x, V y) {
    const V r_sq = mul_add(x, x, y * y);
    const V r = even ? r_sq : square_root(r_sq);
    const V t = r * constant<V>(shape.per_unit);
    V value = constant<V>(0), rise = value;
    for (std::size_t p = shape.terms.size(); p-- > 0;) {
      rise = mul_add(rise, t, value);
      value = mul_add(value, t, constant<V>(shape.terms[p]));
    }
    rise = rise * constant<V>(even ? shape.per_unit + shape.per_unit : shape.per_unit);
    // A cone's tip has no slope over r; its x and y are zero there, and so is what comes of them.
    if (!even) rise = rise / at_least(r, constant<V>(1e-30));
    return on_conic(shape, x, y, r_sq, value, rise);
  }
};

}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // PETZVAL_LENS_SHAPES_POWERS_INL_H_
