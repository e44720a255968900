// SPDX-License-Identifier: BSD-3-Clause
// Tables whose PSFs all lie on one grid, as other programs want them.
#pragma once

#include <petzval/optics/lens_data_table.h>

namespace petzval {

struct PsfGridSize {
  int size = 0;  ///< samples a side
  double spacing_um = 0;
};

/// The finest spacing of the table to three digits, and as many samples as its widest PSF takes; the spacing
/// grows where that would be more than `most_samples`.
PsfGridSize common_grid(const LensDataTable& table, int most_samples = 256);

/// Samples a side, even, of which no PSF keeps less than this share of its light at this spacing.
int size_for_light(const LensDataTable& table, double spacing_um, double share);

/// Lays a PSF on another grid: each sample is a square of light, every point of which goes to the new samples
/// about it by nearness. Sum and centre of gravity stay; the spread grows by a sixth of the new spacing
/// squared and a twelfth of the old. What falls outside is lost to the window: the rest is divided by its
/// sum, and `captured` shrinks by it.
Psf resampled(const Psf& psf, const PsfGridSize& grid);

/// The table with all its PSFs on one grid.
LensDataTable on_common_grid(const LensDataTable& table, const PsfGridSize& grid);

}  // namespace petzval
