// SPDX-License-Identifier: BSD-3-Clause
// Filling a lens data table place by place over the frame.
#pragma once

#include <petzval/analysis/point_spread.h>
#include <petzval/base/progress.h>
#include <petzval/optics/build.h>

namespace petzval {

/// A pupil that vignetting has shrunk to this share of the one on axis counts as dark: its PSF is wider than
/// any grid.
inline constexpr double dark_pupil_share = 1e-3;

/// The sign of object fields that image to +y'.
double towards_positive_image(const Lens& lens);
PsfOptions psf_options_of(const TableOptions& options);

/// Lays a lattice over the frame, finds for each place the object whose chief ray lands there, and fills the
/// table with what comes of it. Where no light arrives g is 0, the object is where its neighbours point, and
/// the PSF is that of the nearest place with light. \param table  with its wavelengths. \throws InputError
/// where no ray passes in the middle.
void fill_frame(const Lens& lens, const TableOptions& options, LensDataTable& table,
                const ProgressCallback& progress);

}  // namespace petzval
