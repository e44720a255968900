// SPDX-License-Identifier: BSD-3-Clause
// A freeform: the conic of c and k, and Σ A_j Z_j(r/R, φ), Z_j the Zernike polynomials of unit mean square in
// Noll's order, φ from +x towards +y (R. J. Noll, J. Opt. Soc. Am. 66, 207, 1976). They are polynomials of x
// and y, and go on beyond R as such. Included once per instruction set.
#if defined(PETZVAL_LENS_SHAPES_ZERNIKE_SAG_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PETZVAL_LENS_SHAPES_ZERNIKE_SAG_INL_H_
#undef PETZVAL_LENS_SHAPES_ZERNIKE_SAG_INL_H_
#else
#define PETZVAL_LENS_SHAPES_ZERNIKE_SAG_INL_H_
#endif

#include <petzval/lens/shapes/xy_polynomial-inl.h>

HWY_BEFORE_NAMESPACE();
namespace petzval::HWY_NAMESPACE {

struct ZernikeSag {
  static constexpr const char* name = "zernike_sag";
  static constexpr bool is_round = false;
  static constexpr ShapeParameter parameters[] = {
      {"normalisation_radius_mm", "the radius R in mm of the unit circle", 1, 1, true},
      {"coefficients_mm", "a coefficient A_j in mm, from Noll's Z_1 on", 1, most_zernike_sag_terms}};

  static std::vector<double> prepare(const Surface& surface) {
    return packed_xy_terms(shape_numbers(surface, "normalisation_radius_mm").at(0),
                           xy_terms_of_zernike(shape_numbers(surface, "coefficients_mm")));
  }

  template <class V, class T>
  static HWY_INLINE SurfacePoint<V> at(const ShapeData<T>& shape, V x, V y) {
    return on_conic_with_xy(shape, x, y);
  }
};

}  // namespace petzval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // PETZVAL_LENS_SHAPES_ZERNIKE_SAG_INL_H_
