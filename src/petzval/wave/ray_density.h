// SPDX-License-Identifier: BSD-3-Clause
// The geometric PSF of a smooth pupil: where its rays land, without interference.
#pragma once

#include <petzval/wave/chord_sum.h>
#include <petzval/wave/smooth_pupil.h>

namespace petzval {

/// The light of rays in the cells of a grid. A ray of direction (α, β) lands at (s, t) = −(λ/n') ∇φ(α, β),
/// and the light a² dα dβ of each small patch of the pupil is spread over the box about its image. What it
/// leaves out of diffraction are the fringes along edges, of width about √(λN · spot), and the far wings:
/// `captured` counts the latter as those of a circular pupil, 1 − E ≈ 2λN/(π² r). For spots of hundreds of
/// λN; see point_spread.h. \param patches_per_cell  of the pupil for a cell's width of the grid, along β;
/// half as many along half a chord. \throws InputError for an empty grid. samples_per_cell is not used.
Psf sum_rays(const SmoothPupil& pupil, const PsfGrid& grid, int patches_per_cell = 2);

}  // namespace petzval
