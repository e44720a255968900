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
///     4  n²     = c₀ + c₁ λ^c₂/(λ² − c₃^c₄) + c₅ λ^c₆/(λ² − c₇^c₈) + Σ cᵢ λ^cᵢ₊₁   rational
///     5  n      = c₀ + Σ cᵢ λ^cᵢ₊₁              Cauchy
///     6  n − 1  = c₀ + Σ cᵢ / (cᵢ₊₁ − λ⁻²)      gases
///     7  n      = c₀ + c₁ L + c₂ L² + c₃ λ² + c₄ λ⁴ + c₅ λ⁶, L = 1/(λ² − 0.028)   Herzberger
///     8  (n² − 1)/(n² + 2) = c₀ + c₁ λ²/(λ² − c₂) + c₃ λ²                         retro
///     9  n²     = c₀ + c₁/(λ² − c₂) + c₃ (λ − c₄)/((λ − c₄)² + c₅)                 exotic
/// Coefficients that are left out at the end are 0. \throws InputError as check_dispersion_formula, for a
/// wavelength that is not positive, and where the formula gives no finite positive index.
double dispersion_formula(int formula, std::span<const double> coefficients, double wavelength_nm);

/// \throws InputError for another formula, for too many coefficients, and for a sum of pairs (formulas 1, 2,
/// 3, 5, 6) with an even number of them.
void check_dispersion_formula(int formula, std::span<const double> coefficients);

/// Index of air at 20 °C and 1 atm against vacuum (F. Kohlrausch, Praktische Physik, 1968, as glass makers
/// use it: Schott, Technical Information 19); 1.00027 in the visible. \param wavelength_nm  in vacuum; above
/// 200.
double air_index(double wavelength_nm);

/// The formula in words and symbols, for people. \throws InputError as above.
const char* dispersion_formula_text(int formula);

/// Index of a model glass, known by nd and Vd alone: Conrady's n = A + B/λ + C/λ^3.5 (A. E. Conrady, Applied
/// Optics and Optical Design II, 1960) through n_d, n_F − n_C = (nd − 1)/Vd, and the partial dispersion
/// P_gF = (n_g − n_F)/(n_F − n_C) = 0.6438 − 0.001682·Vd of normal glasses (the line through K7 and F2;
/// Schott, Technical Information 29). Beyond Vd = 100, where no glass is, P_gF stays at its value there, so
/// that the dispersion vanishes as Vd grows. `dpgf` is the deviation of P_gF from that line. Against the
/// 1,609 catalogue glasses the median error is 3e-6 at e, 1.4e-5 at F and C and 9e-5 at g; glasses of
/// anomalous dispersion miss g by up to 0.07 of their n_F − n_C.
///
/// \throws InputError unless nd ≥ 1, Vd > 0, dpgf is finite and the wavelength is within 300 to 2500 nm.
double model_glass_index(double nd, double vd, double wavelength_nm, double dpgf = 0);

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
