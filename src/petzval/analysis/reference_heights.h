// SPDX-License-Identifier: BSD-3-Clause
// Where the chief rays of the reference wavelength land.
#pragma once

#include <petzval/analysis/field_tables.h>

#include <array>
#include <map>

namespace petzval {

/// Chief-ray image points x', y' [mm] at the lens's reference wavelength by object field, for the fields of
/// a request; x' is 0 of a centred lens. \throws InputError naming a field that no chief ray passes at.
std::map<double, std::array<double, 2>> reference_points_mm(const Lens& lens,
                                                            const FieldTableRequest& request);

}  // namespace petzval
