// SPDX-License-Identifier: BSD-3-Clause
// How the refractive index depends on wavelength: makers' formulas, the model glass, tables, Abbe numbers.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace petzval {

/// Spectral lines of optical glass catalogues [nm] (ISO 7944): hydrogen F and C, helium d, mercury e and g.
namespace spectral_line {
inline constexpr double g_nm = 435.8343;
inline constexpr double f_nm = 486.1327;
inline constexpr double e_nm = 546.0740;
inline constexpr double d_nm = 587.5618;
inline constexpr double c_nm = 656.2725;
}  // namespace spectral_line

/// Index by a formula of refractiveindex.info ("Dispersion formulas", M. N. Polyanskiy), λ in µm:
///     1  n² − 1 = c₀ + Σ cᵢ λ² / (λ² − cᵢ₊₁²)   Sellmeier
///     2  n² − 1 = c₀ + Σ cᵢ λ² / (λ² − cᵢ₊₁)    Sellmeier, as glass makers print it
///     3  n²     = c₀ + Σ cᵢ λ^cᵢ₊₁              power series (Schott's of 1967 among others)
///     5  n      = c₀ + Σ cᵢ λ^cᵢ₊₁              Cauchy
/// \throws InputError for another formula, an even number of coefficients, a wavelength that is not positive,
/// and where the formula gives no finite positive index.
double dispersion_formula(int formula, std::span<const double> coefficients, double wavelength_nm);

/// The formula in words and symbols, for people. \throws InputError as above.
const char* dispersion_formula_text(int formula);

/// Index of a model glass, known by nd and Vd alone: Conrady's n = A + B/λ + C/λ^3.5 (A. E. Conrady, Applied
/// Optics and Optical Design II, 1960) through n_d, n_F − n_C = (nd − 1)/Vd, and the partial dispersion
/// P_gF = (n_g − n_F)/(n_F − n_C) = 0.6438 − 0.001682·Vd of normal glasses (the line through K7 and F2;
/// Schott, Technical Information 29). Beyond Vd = 100, where no glass is, P_gF stays at its value there, so
/// that the dispersion vanishes as Vd grows. Against the 1,609 catalogue glasses the median error is 3e-6 at
/// e, 1.4e-5 at F and C and 9e-5 at g; glasses of anomalous dispersion miss g by up to 0.07 of their n_F −
/// n_C.
///
/// \throws InputError unless nd ≥ 1, Vd > 0 and the wavelength is within 300 to 2500 nm.
double model_glass_index(double nd, double vd, double wavelength_nm);

/// Index from a table of (wavelength [nm], n) with increasing wavelengths: exact at the entries, a monotone
/// cubic in between; the ends may be passed by 1e-6 nm. The caller has checked the table.
///
/// \throws InputError outside the table.
double tabulated_index(std::span<const std::pair<double, double>> table, double wavelength_nm);

/// The two numbers that place a glass in the glass map.
struct AbbeNumbers {
  double nd;
  double vd;  ///< (nd − 1)/(n_F − n_C); infinite without dispersion
};

/// \param index  refractive index at a wavelength [nm]
AbbeNumbers abbe_numbers(const std::function<double(double)>& index);

}  // namespace petzval
