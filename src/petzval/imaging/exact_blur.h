// SPDX-License-Identifier: BSD-3-Clause
// Shift-variant blur without approximation: the oracle for all faster methods.
#pragma once

#include <petzval/base/progress.h>
#include <petzval/imaging/cell_plane.h>
#include <petzval/imaging/psf_kernel.h>

namespace petzval {

/// Blurs a plane whose every cell has its own kernel, added up directly in double precision. Parameters as
/// blur_sections(). Slow: one kernel a cell.
CellPlane blur_exact(const CellPlane& source, const PsfField& psfs, int margin,
                     const ProgressCallback& progress = {});

/// The same of mirror symmetric kernels (KernelSymmetry::mirrored): one is made for the four places on either
/// side of both axes.
CellPlane blur_mirrored(const CellPlane& source, const PsfField& psfs, int margin);

}  // namespace petzval
