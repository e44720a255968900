// SPDX-License-Identifier: BSD-3-Clause
// The light that converges on one image point, as smooth functions of its direction.
#pragma once

#include <petzval/numeric/chebyshev_surface.h>

#include <cstddef>
#include <vector>

namespace petzval {

/// A pupil over the exit direction cosines (α, β) of Psf's directions s and t: an outline, and inside it the
/// phase and amplitude of PupilWaves as polynomials. Mirror symmetric in α. What it saves: once few rays have
/// been traced, the sum over plane waves may take its nodes where they are cheapest.
struct SmoothPupil {
  /// Half of the outline, α ≥ 0, from its highest β to its lowest; both ends have α = 0.
  std::vector<double> outline_alpha, outline_beta;
  /// Entries of the outline, rising, where one aperture takes over from another: between two corners it is
  /// smooth.
  std::vector<std::size_t> corners;
  ChebyshevSurface phase_waves;  ///< φ of PupilWaves
  ChebyshevSurface amplitude;    ///< a = √(T dq/(dα dβ))
  double wavelength_nm = 0;
  double image_index = 1;
  double flux = 0;  ///< ∬ T dq over the whole pupil
  /// Where the rays land about the chief ray's point: |s| and the range of t.
  double reach_s_mm = 0, low_t_mm = 0, high_t_mm = 0;

  double alpha_max() const;
  double beta_low() const { return outline_beta.back(); }
  double beta_high() const { return outline_beta.front(); }
  /// The pupil's widths along α and β, the larger and the smaller of the two.
  double widest() const;
  double narrowest() const;
  /// λ N = λ/(n' · width) of the wider direction [mm]: the PSF holds no finer detail than half of it.
  double lambda_n_mm() const;
  /// The pupil holds α < half_chord(β); 0 outside. Third order in α², which is exact for ellipses.
  double half_chord(double beta) const;
  /// ∬ a² dα dβ over the outline: the flux, if outline and amplitude belong together.
  double amplitude_square_integral() const;
};

/// Where the chords' smoothness in β ends: the lowest β, the corners and the highest, rising.
std::vector<double> smooth_intervals(const SmoothPupil& pupil);

}  // namespace petzval
