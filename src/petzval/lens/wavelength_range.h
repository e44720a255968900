// SPDX-License-Identifier: BSD-3-Clause
// The light that a lens can be computed for.
#pragma once

#include <petzval/lens/lens.h>

#include <limits>
#include <vector>

namespace petzval {

/// Wavelengths from one to another [nm].
struct LensWavelengths {
  double shortest_nm = 0, longest_nm = std::numeric_limits<double>::infinity();
};

/// Where the indices of all its glasses are known: catalogues say from where to where, tables by their ends;
/// an index given by itself, or by nd and Vd, ends nowhere.
LensWavelengths wavelength_range(const Lens& lens);

/// Whether rays of these wavelengths part in it.
bool disperses(const Lens& lens, const std::vector<double>& wavelengths_nm);

}  // namespace petzval
