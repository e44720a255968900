// SPDX-License-Identifier: BSD-3-Clause
// Zernike circle polynomials over the unit disc, and wavefronts written as sums of them.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace petzval {

/// Which polynomial has which number, counted from 1, and how large it is.
enum class ZernikeOrder {
  /// R. J. Noll, J. Opt. Soc. Am. 66 (1976) 207: orthonormal, the mean of Z² over the disc is 1, so that the
  /// RMS of a wavefront without piston is the root of the sum of squares of its coefficients.
  noll,
  /// The 37 terms of the Fringe (University of Arizona) set, each 1 in size at the rim; the 37th is R_12^0.
  /// (J. C. Wyant & K. Creath, Applied Optics and Optical Engineering XI (1992) 28-34.)
  fringe
};

/// Z = N R_n^|m|(ρ) cos mθ for m ≥ 0, N R_n^|m|(ρ) sin |m|θ for m < 0; θ runs from +x towards +y.
struct ZernikeTerm {
  int n = 0, m = 0;
  friend bool operator==(const ZernikeTerm&, const ZernikeTerm&) = default;
};

inline constexpr int largest_noll_index = 10000, largest_fringe_index = 37;

/// \throws InputError for an index below 1 or beyond the largest.
ZernikeTerm zernike_term(ZernikeOrder order, int index);

/// "defocus", "coma y", "trefoil x", "spherical", …; "Z(8, 2)" beyond the sixth order.
std::string zernike_name(const ZernikeTerm& term);

/// R_n^m(ρ), 1 at ρ = 1, for n − m even and n ≥ m ≥ 0; by the recurrence of Jacobi polynomials, which keeps
/// its digits at any order. (Born & Wolf, Principles of Optics, 7th ed., section 9.2.)
double zernike_radial(int n, int m, double rho);

/// One polynomial at a point (x, y) of the disc, whose rim is x² + y² = 1. \throws InputError as
/// zernike_term().
double zernike(ZernikeOrder order, int index, double x, double y);

/// Σ c_j Z_j, coefficients[0] being that of Z_1. \throws InputError as zernike_term().
double zernike_sum(ZernikeOrder order, std::span<const double> coefficients, double x, double y);

struct ZernikeFit {
  std::vector<double> coefficients;  ///< [0] is that of Z_1, in the unit of the values
  double rms_residual = 0;           ///< weighted, of what the terms leave
};

/// The first `terms` polynomials that fit the values best: least Σ weight (value − Σ c_j Z_j)², by
/// Householder QR. Points may fill any part of the disc (a vignetted pupil) or lie outside; with weights that
/// are areas of the whole disc the coefficients of the orthonormal set do not depend on how many terms are
/// fitted. \throws InputError if the sizes differ, a number is not finite, a weight is negative, the points
/// are fewer than the terms or cannot tell the terms apart.
ZernikeFit fit_zernike(ZernikeOrder order, int terms, std::span<const double> x, std::span<const double> y,
                       std::span<const double> values, std::span<const double> weights);

}  // namespace petzval
