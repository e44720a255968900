// SPDX-License-Identifier: BSD-3-Clause
// The object fields of a table by height.
#pragma once

#include <petzval/optics/build.h>

#include <vector>

namespace petzval {

/// As many as asked for, evenly from 0 to the field whose image lies a PSF's reach beyond the asked height at
/// any wavelength, or to the last one before the image of some wavelength ends or folds back.
/// \throws InputError if no ray passes on the axis, or none beside it.
std::vector<double> fields_of_table(const Lens& lens, const TableOptions& options);

}  // namespace petzval
