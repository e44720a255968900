// SPDX-License-Identifier: BSD-3-Clause
// Shift-variant blur as the paper does it: one PSF a section, by Fourier transform.
#pragma once

#include <petzval/base/progress.h>
#include <petzval/imaging/cell_plane.h>
#include <petzval/imaging/psf_kernel.h>

namespace petzval {

struct SectionOptions {
  int section = 16;   ///< cells along a side of a section, 1 to 4096
  int transform = 0;  ///< cells along a side of the transforms; 0: the smallest good size
  /// Sections reach over half of their neighbours and fade into them, linearly from centre to centre: the
  /// kernel of every cell is then a bilinear mixture of the four nearest sections' kernels, without seams.
  bool blend = false;

  /// Cells along a side of what a section takes in: itself, or twice as much when it fades.
  int window() const { return !blend ? section : 2 * section - section % 2; }
};

/// The size of the transforms for PSFs of this radius: a section and the PSF about it must fit without
/// wrapping. \throws InputError if a section size is not valid or the transform asked for is too small, with
/// the right one.
int transform_size(const SectionOptions& options, int radius);

/// Blurs a plane whose every section of n × n cells shares the kernel of its centre (Maeda, Catrysse &
/// Wandell 2005, section 2.2.3): each section is padded with zeros, transformed, multiplied, transformed back
/// and added to the result. Sections lie symmetric about the axis where their number allows, and where the
/// PSFs are mirror symmetric, mirrored sections share a kernel.
///
/// \param source  light before blur; nothing comes from outside it.
/// \param margin  the result is the source's grid less this many cells on every side; light that leaves it is
/// lost. \param progress  told the fraction that is done. Rounding of the transforms (float) leaves errors of
/// about 1e-7 of the brightest cell of a section, of both signs. Same bytes for any number of threads.
CellPlane blur_sections(const CellPlane& source, const PsfField& psfs, int margin,
                        const SectionOptions& options, const ProgressCallback& progress = {});

}  // namespace petzval
