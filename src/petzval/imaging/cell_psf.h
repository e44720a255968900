// SPDX-License-Identifier: BSD-3-Clause
// The PSFs of a lens data table, made ready for kernels on cells of one size.
#pragma once

#include <petzval/imaging/kernel_maker.h>
#include <petzval/imaging/psf_deposit.h>
#include <petzval/wave/psf.h>

namespace petzval {

/// How far samples that hold light lie from the centre of a kernel [µm].
struct PsfExtent {
  double reach_um = 0;      ///< the farthest
  double half_side_um = 0;  ///< along s or t, the farther
};
/// \param origin_t_um, origin_s_um  of the kernel's centre, beyond the chief ray.
PsfExtent extent_of(const Psf& psf, double origin_t_um, double origin_s_um = 0);

/// Whether there are samples, and light in them.
bool has_light(const Psf& psf);

/// Adds a PSF to what is known of a reach. \throws InputError if it spans more than 4000 cells.
void add_to_reach(const Psf& psf, const PsfExtent& extent, double cell_um, PsfReach& reach);

/// With samples that are as fine as cells need them, and no finer.
MergedPsf merged_psf(const Psf& table, double origin_um, double cell_um);

}  // namespace petzval
