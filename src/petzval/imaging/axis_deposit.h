// SPDX-License-Identifier: BSD-3-Clause
// A PSF on the cells of a kernel, both along the same axes.
#pragma once

#include <petzval/imaging/psf_deposit.h>

#include <cstddef>

namespace petzval {

/// How samples lie along the cells of one axis, from the middle of a kernel's middle cell [cells].
struct PlacedLine {
  double first;  ///< the first sample
  double step;   ///< to the next
};

/// Adds weight · samples to a kernel, integrated over its cells: between samples light is linear; samples
/// coarser than half a cell are squares. One axis after the other. What falls outside the kernel is left out.
/// \param samples  size × size, row-major, then row_padding(). \param down, across  of the rows, and of the
/// samples of a row.
void deposit_along_axes(const float* samples, std::size_t size, double weight, const PlacedLine& down,
                        const PlacedLine& across, Kernel& kernel);

}  // namespace petzval
