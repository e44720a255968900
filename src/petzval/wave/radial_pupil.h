// SPDX-License-Identifier: BSD-3-Clause
// A rotationally symmetric pupil: clear or centrally obstructed, with defocus and spherical aberration.
#pragma once

#include <span>
#include <vector>

namespace petzval {

/// The pupil exp(2πi W(ρ)) for obstruction ≤ ρ ≤ 1, ρ = 1 at the rim.
struct RadialPupil {
  /// Wavefront aberration at the rim [waves], by term: W020 ρ², W040 ρ⁴, W060 ρ⁶, …
  std::vector<double> w_waves;
  double obstruction = 0;  ///< radius of the central obstruction over that of the pupil, below 1

  /// W(t), t = ρ², and its derivatives by t.
  double aberration(double t) const;
  double slope(double t) const;
  /// \throws InputError for coefficients that are not finite or above 1000 waves, or an obstruction outside
  /// [0, 1).
  void validate() const;
};

/// Point-spread function at distances r [units of λN], 1 at the centre of an unaberrated pupil of the same
/// shape: |2 ∫ exp(2πi W(ρ)) J0(πrρ) ρ dρ|² / (1 − obstruction²)². Times π (1 − obstruction²)/4 it is the
/// share of light per (λN)². Gauss-Legendre with nodes enough for the fastest oscillation; error below 1e-12.
/// \throws InputError as validate(), or for an r that is not finite or beyond 10,000.
std::vector<double> radial_psf(const RadialPupil& pupil, std::span<const double> r);

/// Optical transfer function at s = ν/ν_c, the frequency over the cut-off 1/(λN), s ≥ 0: the autocorrelation
/// of the pupil (Hopkins, Proc. R. Soc. A 231 (1955) 91), integrated over the overlap of the shifted pupils
/// by Gauss-Legendre in angles in which the overlap has no corners. Real and signed; 1 at s = 0, 0 from s = 1
/// on. Error below 1e-12. \throws InputError as validate().
std::vector<double> radial_otf(const RadialPupil& pupil, std::span<const double> s);

/// The same at 0, 1/count, … 1: from Chebyshev interpolants between the frequencies at which the overlap
/// changes its kind, so that a fine table costs little.
std::vector<double> radial_otf_table(const RadialPupil& pupil, int count);

/// Mean of the PSF over its own ripple, far away: share of light per (λN)² → k3/r³ + k5/r⁵ (asymptotic
/// expansion of the Hankel transform at the rims; W enters through its slope there).
struct RadialTail {
  double k3 = 0, k5 = 0;
};
RadialTail radial_tail(const RadialPupil& pupil);

/// The largest transverse aberration [units of λN]: 2 max |dW/dρ|. A defocused pupil has 4 |W020|, half the
/// blur disc's diameter of 8 λN |W020|.
double geometric_radius(const RadialPupil& pupil);

}  // namespace petzval
