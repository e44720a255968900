// SPDX-License-Identifier: BSD-3-Clause
// A toroid: the curve g(y) = c y²/(1 + √(1 − (1 + k) c² y²)) + Σ A_i (y/R)^2i of the y-z plane, turned about
// a line along y whose distance is the radius of rotation, 1/ρ. From (z − 1/ρ)² + x² = (1/ρ − g)² follows z =
// E/(1 + √(1 − ρE)) with E = ρx² + 2g − ρg², also of a cylinder, ρ = 0. Included once per instruction set.
#if defined(PETZVAL_LENS_SHAPES_TOROID_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PETZVAL_LENS_SHAPES_TOROID_INL_H_
#undef PETZVAL_LENS_SHAPES_TOROID_INL_H_
#else
#define PETZVAL_LENS_SHAPES_TOROID_INL_H_
#endif

#include <petzval/lens/shapes/numbers-inl.h>
#include <petzval/lens/shapes/shape_data.h>
#include <petzval/lens/surface_kind.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {

struct Toroid {
  static constexpr const char* name = "toroid";
  static constexpr bool is_round = false;
  static constexpr ShapeParameter parameters[] = {
      {"rotation_curvature_per_mm", "one over the radius of rotation in mm", -1},
      {"normalisation_radius_mm", "the radius in mm that y is divided by", 1, 1, true},
      {"coefficients_mm", "a coefficient A_i in mm, of (y/R)^2 and on", 1, 15}};

  /// ρ, 1/R, A_1 ….
  static std::vector<double> prepare(const Surface& surface) {
    const std::vector<double> rotation = shape_numbers(surface, "rotation_curvature_per_mm");
    std::vector<double> terms{rotation.empty() ? 0.0 : rotation[0],
                              1 / shape_numbers(surface, "normalisation_radius_mm").at(0)};
    for (const double coefficient : shape_numbers(surface, "coefficients_mm")) terms.push_back(coefficient);
    return terms;
  }

  template <class V, class T>
  static HWY_INLINE SurfacePoint<V> at(const ShapeData<T>& shape, V x, V y) {
    const V rotation = constant<V>(shape.terms[0]), per_radius = constant<V>(shape.terms[1]);
    const V zero = constant<V>(0), one = constant<V>(1), two = constant<V>(2),
            c = constant<V>(shape.curvature);
    const V u = y * per_radius, u_sq = u * u;
    V sum = zero, rise = zero;  // Σ A_i u^(2i − 2), and by u²
    for (std::size_t i = shape.terms.size(); i-- > 2;) {
      rise = mul_add(rise, u_sq, sum);
      sum = mul_add(sum, u_sq, constant<V>(shape.terms[i]));
    }
    const V bend = constant<V>(shape.one_plus_conic * shape.curvature * shape.curvature);
    const V conic_root = square_root(neg_mul_add(bend * y, y, one));  // NaN beyond the rim
    const V g = mul_add(c * y, y / (one + conic_root), u_sq * sum);
    const V g_slope = y * (c / conic_root) + two * u * per_radius * mul_add(u_sq, rise, sum);
    const V e = dot_add(rotation * x, x, two - rotation * g, g, zero);
    const V root = square_root(neg_mul_add(rotation, e, one));
    // ρz² − 2z + E = 0: dz (1 − ρz) = dE/2, and 1 − ρz is the root.
    return {e / (one + root), rotation * x / root, (one - rotation * g) * g_slope / root};
  }
};

}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // PETZVAL_LENS_SHAPES_TOROID_INL_H_
