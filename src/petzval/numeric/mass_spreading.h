// SPDX-License-Identifier: BSD-3-Clause
// A point mass spread over a grid by the kernel of non-uniform transforms, in the widest vectors there are.
#pragma once

#include <cstddef>

namespace petzval {

/// Where a mass lies between cells along both axes: SpreadingKernel::values().
struct SpreadMass {
  double across_offset = 0, down_offset = 0;
  double mass = 0;
};

/// Adds it to rows `first` … `last` − 1 of the square of SpreadingKernel::width cells a side that it reaches.
/// \param cells  the first of row `first`. \param stride  from one row to the next.
void spread_mass(const SpreadMass& mass, int first, int last, double* cells, std::ptrdiff_t stride);

}  // namespace petzval
