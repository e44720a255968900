// SPDX-License-Identifier: BSD-3-Clause
// Kernels at the nodes of tiles, as seen from the axis outwards.
#pragma once

#include <petzval/imaging/product_layout.h>
#include <petzval/imaging/psf_kernel.h>

#include <vector>

namespace petzval {

/// The kernel at a place counted from the axis [cells], rows and columns growing outwards. \param mirrored
/// in the quadrants left of the axis and below it, and right and above, where PSFs are not mirror symmetric.
Kernel kernel_at_node(const PsfField& psfs, const OutwardAxis& across, const OutwardAxis& down, double column,
                      double row, bool mirrored);

/// The Lagrange polynomials of the nodes at the cells along a side of a tile: [node][cell].
std::vector<float> cell_weights(const std::vector<double>& nodes, int tile);

}  // namespace petzval
