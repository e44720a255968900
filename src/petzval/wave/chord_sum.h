// SPDX-License-Identifier: BSD-3-Clause
// The diffraction PSF of a smooth pupil, summed over its chords.
#pragma once

#include <petzval/wave/psf.h>
#include <petzval/wave/smooth_pupil.h>

namespace petzval {

/// Where a PSF is wanted: size × size cells of `spacing_um`, each the light of a square of samples_per_cell²
/// points at the middles of its parts.
struct PsfGrid {
  int size = 0;
  double spacing_um = 0;
  int samples_per_cell = 1;
  /// Cells outside these rows, and farther than `reach` columns from the middle one, are left dark; −1: none
  /// are.
  int first_row = 0, last_row = -1, reach = -1;

  double sample_spacing_um() const { return spacing_um / samples_per_cell; }
};

/// The sum of plane waves of sum_plane_waves() over a smooth pupil: Gauss-Legendre panels along β and along
/// every chord of constant β, so that the two directions separate, U = Σ_β e^{ikβt} Σ_α g 2cos(kαs). For n
/// samples a side that takes about n³ steps where nodes in any order take n⁴. Nodes are as many as the phase
/// in the window needs. `captured` is the window's share of the flux.
/// \throws InputError for an empty grid or one beyond 2^14 samples a side.
Psf sum_chords(const SmoothPupil& pupil, const PsfGrid& grid);

}  // namespace petzval
