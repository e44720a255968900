// SPDX-License-Identifier: BSD-3-Clause
// Forbes' Qcon asphere: a conic, and u⁴ Σ A_m Q_m(u²) with u = r/R and the Jacobi polynomials
// Q_m(x) = P_m^(0,4)(2x − 1), which are orthogonal over the aperture, so that each coefficient says by how
// much the surface departs there (G. W. Forbes, Optics Express 15, 5218, 2007, eq. 8 and section 3). Included
// once per instruction set.
#if defined(PETZVAL_LENS_SHAPES_QCON_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PETZVAL_LENS_SHAPES_QCON_INL_H_
#undef PETZVAL_LENS_SHAPES_QCON_INL_H_
#else
#define PETZVAL_LENS_SHAPES_QCON_INL_H_
#endif

#include <petzval/lens/shapes/powers-inl.h>
#include <petzval/lens/surface_kind.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {

struct Qcon {
  static constexpr const char* name = "qcon";
  static constexpr bool is_round = true;
  static constexpr ShapeParameter parameters[] = {
      {"normalisation_radius_mm", "the radius in mm at which u is 1", 1, 1, true},
      {"coefficients_mm", "a coefficient A_m in mm, from A_0 on", 1, 30}};

  /// 1/R², and for each m: A_m, then a, b, c of Q_{m+1} = (a + b x) Q_m − c Q_{m−1} (Abramowitz and Stegun,
  /// Handbook of Mathematical Functions, 1964, 22.7.1, α = 0, β = 4).
  static std::vector<double> prepare(const Surface& surface) {
    const double radius = shape_numbers(surface, "normalisation_radius_mm").at(0);
    std::vector<double> terms{1 / (radius * radius)};
    double m = 1;
    for (const double coefficient : shape_numbers(surface, "coefficients_mm")) {
      const double s = 2 * m + 4, divisor = 2 * m * (m + 4) * (s - 2);
      const double linear = (s - 1) * s * (s - 2) / divisor;  // of 2x − 1
      terms.insert(terms.end(), {coefficient, -16 * (s - 1) / divisor - linear, 2 * linear,
                                 2 * (m - 1) * (m + 3) * s / divisor});
      ++m;
    }
    return terms;
  }

  template <class V, class T>
  static HWY_INLINE SurfacePoint<V> at(const ShapeData<T>& shape, V x, V y) {
    const V r_sq = mul_add(x, x, y * y), per_radius_sq = constant<V>(shape.terms[0]),
            u_sq = r_sq * per_radius_sq;
    V q = constant<V>(1), last_q = constant<V>(0), slope = last_q, last_slope = last_q;
    V sum = last_q, rise = last_q;  // Σ A_m Q_m, and by x
    for (std::size_t i = 1; i < shape.terms.size(); i += 4) {
      const V coefficient = constant<V>(shape.terms[i]), b = constant<V>(shape.terms[i + 2]);
      const V factor = mul_add(b, u_sq, constant<V>(shape.terms[i + 1])), c = constant<V>(shape.terms[i + 3]);
      sum = mul_add(coefficient, q, sum);
      rise = mul_add(coefficient, slope, rise);
      const V next_slope = mul_add(factor, slope, neg_mul_add(c, last_slope, b * q));
      const V next_q = neg_mul_add(c, last_q, factor * q);
      last_q = q, q = next_q, last_slope = slope, slope = next_slope;
    }
    const V by_u_sq = u_sq * mul_add(u_sq, rise, sum + sum);
    return on_conic(shape, x, y, r_sq, u_sq * u_sq * sum, (by_u_sq + by_u_sq) * per_radius_sq);
  }
};

}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // PETZVAL_LENS_SHAPES_QCON_INL_H_
