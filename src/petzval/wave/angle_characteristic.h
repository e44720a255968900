// SPDX-License-Identifier: BSD-3-Clause
// The diffraction PSF of a real lens on its flat sensor, as a sum of plane waves.
#pragma once

#include <petzval/wave/psf.h>

#include <cstddef>
#include <vector>

namespace petzval {

/// The light that converges on one image point, as plane waves: one node per traced ray, on the half of the
/// pupil with α ≥ 0 where the other half is its mirror image (α → −α), else all over the pupil.
struct PupilWaves {
  std::vector<double> alpha, beta;  ///< exit direction cosines along s and t of Psf
  std::vector<double> phase_waves;  ///< φ: optical path to the foot of the perpendicular from the chief-ray
                                    ///< image point, minus the chief ray's, over λ
  std::vector<double> amplitude;    ///< quadrature weight dα dβ times amplitude a = √(T dq/(dα dβ))
  bool mirrored = true;             ///< nodes stand for their mirror images, too
  double wavelength_nm = 0;
  double image_index = 1;
  /// ∬ T dq over the whole pupil: what λ⁻² times the integral of |U|² over the plane must come to (Parseval).
  double flux = 0;

  std::size_t size() const { return alpha.size(); }
};

/// U(s, t) = Σ_j amplitude_j exp(2πi φ_j) exp(i k (α_j s + β_j t)), k = 2π n'/λ, on a size × size grid, by
/// one non-uniform transform; the PSF is |U|² normalised to unit sum. No reference sphere and no projection
/// step: it holds on the flat sensor at any field angle (docs/CONVENTIONS.md, "Point-spread function").
/// `captured` is the window's share of the flux. \throws InputError for a size below 1 or a spacing that is
/// not positive.
Psf sum_plane_waves(const PupilWaves& waves, int size, double spacing_um);

}  // namespace petzval
