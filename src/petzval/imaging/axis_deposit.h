// SPDX-License-Identifier: BSD-3-Clause
// A PSF on the cells of a kernel, both along the same axes.
#pragma once

#include <petzval/imaging/psf_deposit.h>
#include <petzval/imaging/sample_scatter.h>

namespace petzval {

/// Adds weight · samples to a kernel, integrated over its cells: between samples light is linear; samples
/// coarser than half a cell are squares. One axis after the other. What falls outside the kernel is left out.
/// \param lattice  rows of samples along rows of the kernel, from the middle of its middle cell.
void deposit_along_axes(const SampleSquare& psf, const PlacedLattice& lattice, Kernel& kernel);

}  // namespace petzval
