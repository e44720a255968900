// SPDX-License-Identifier: BSD-3-Clause
// A freeform: the conic of c and k, and Σ A_ij (x/R)^i (y/R)^j. Included once per instruction set.
#if defined(PETZVAL_LENS_SHAPES_XY_POLYNOMIAL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PETZVAL_LENS_SHAPES_XY_POLYNOMIAL_INL_H_
#undef PETZVAL_LENS_SHAPES_XY_POLYNOMIAL_INL_H_
#else
#define PETZVAL_LENS_SHAPES_XY_POLYNOMIAL_INL_H_
#endif

#include <petzval/lens/shapes/numbers-inl.h>
#include <petzval/lens/shapes/shape_data.h>
#include <petzval/lens/shapes/xy_terms.h>
#include <petzval/lens/surface_kind.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {

/// `terms` as packed_xy_terms() makes them: Horner's scheme in x of Horner's schemes in y.
template <class V, class T>
HWY_INLINE SurfacePoint<V> on_conic_with_xy(const ShapeData<T>& shape, V x, V y) {
  const V c = constant<V>(shape.curvature), zero = constant<V>(0), one = constant<V>(1);
  const V q_c_sq = constant<V>(shape.one_plus_conic * shape.curvature * shape.curvature);
  const V r_sq = mul_add(x, x, y * y);
  const V root = square_root(neg_mul_add(q_c_sq, r_sq, one));  // NaN beyond the rim
  const V per_radius = constant<V>(shape.terms[0]), u = x * per_radius, v = y * per_radius;
  V sum = zero, by_u = zero, by_v = zero;
  std::size_t next = 1;
  for (std::size_t length = 1; next < shape.terms.size(); ++length) {
    V row = zero, row_by_v = zero;
    for (std::size_t j = 0; j < length; ++j, ++next) {
      row_by_v = mul_add(row_by_v, v, row);
      row = mul_add(row, v, constant<V>(shape.terms[next]));
    }
    by_u = mul_add(by_u, u, sum);
    by_v = mul_add(by_v, u, row_by_v);
    sum = mul_add(sum, u, row);
  }
  const V slope_over_r = c / root;
  return {mul_div_add(c, r_sq, one + root, sum), mul_add(slope_over_r, x, by_u * per_radius),
          mul_add(slope_over_r, y, by_v * per_radius)};
}

struct XyPolynomial {
  static constexpr const char* name = "xy_polynomial";
  static constexpr bool is_round = false;
  static constexpr ShapeParameter parameters[] = {
      {"normalisation_radius_mm", "the radius R in mm that x and y are divided by", 1, 1, true},
      {"coefficients_mm", "a coefficient in mm, of x, y, x^2, xy, y^2, x^3 and on", 1, most_xy_terms}};

  static std::vector<double> prepare(const Surface& surface) {
    return packed_xy_terms(shape_numbers(surface, "normalisation_radius_mm").at(0),
                           xy_terms_of_list(shape_numbers(surface, "coefficients_mm")));
  }

  template <class V, class T>
  static HWY_INLINE SurfacePoint<V> at(const ShapeData<T>& shape, V x, V y) {
    return on_conic_with_xy(shape, x, y);
  }
};

}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // PETZVAL_LENS_SHAPES_XY_POLYNOMIAL_INL_H_
