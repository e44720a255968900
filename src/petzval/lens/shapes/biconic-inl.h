// SPDX-License-Identifier: BSD-3-Clause
// A biconic: z = (a x² + c y²)/(1 + √(1 − (1 + h) a² x² − (1 + k) c² y²)), with a and h along x, and the
// surface's own c and k along y. Included once per instruction set.
#if defined(PETZVAL_LENS_SHAPES_BICONIC_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PETZVAL_LENS_SHAPES_BICONIC_INL_H_
#undef PETZVAL_LENS_SHAPES_BICONIC_INL_H_
#else
#define PETZVAL_LENS_SHAPES_BICONIC_INL_H_
#endif

#include <petzval/lens/shapes/numbers-inl.h>
#include <petzval/lens/shapes/shape_data.h>
#include <petzval/lens/surface_kind.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {

struct Biconic {
  static constexpr const char* name = "biconic";
  static constexpr bool is_round = false;
  static constexpr ShapeParameter parameters[] = {{"curvature_x_per_mm", "the curvature along x in 1/mm", -1},
                                                  {"conic_x", "the conic constant along x", 0}};

  /// a, and (1 + h) a².
  static std::vector<double> prepare(const Surface& surface) {
    const auto number = [&](const char* key) {
      const std::vector<double> given = shape_numbers(surface, key);
      return given.empty() ? 0.0 : given[0];
    };
    const double a = number("curvature_x_per_mm");
    return {a, (1 + number("conic_x")) * a * a};
  }

  /// From z (1 + s) = a x² + c y² with s² = 1 − q_x x² − q_y y²: dz/dx (1 + s) = x (2a + q_x z/s).
  template <class V, class T>
  static HWY_INLINE SurfacePoint<V> at(const ShapeData<T>& shape, V x, V y) {
    const V a = constant<V>(shape.terms[0]), q_x = constant<V>(shape.terms[1]);
    const V c = constant<V>(shape.curvature), one = constant<V>(1), two = constant<V>(2);
    const V q_y = constant<V>(shape.one_plus_conic * shape.curvature * shape.curvature);
    const V root = square_root(neg_mul_add(q_x * x, x, neg_mul_add(q_y * y, y, one)));  // NaN beyond the rim
    const V per_sum = one / (one + root);
    const V sag = dot_add(a * x, x, c * y, y, constant<V>(0)) * per_sum;
    const V pull = sag / root;
    return {sag, x * mul_add(two, a, q_x * pull) * per_sum, y * mul_add(two, c, q_y * pull) * per_sum};
  }
};

}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // PETZVAL_LENS_SHAPES_BICONIC_INL_H_
