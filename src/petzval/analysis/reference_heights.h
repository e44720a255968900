// SPDX-License-Identifier: BSD-3-Clause
// Where the chief rays of the reference wavelength land.
#pragma once

#include <petzval/analysis/field_tables.h>

#include <map>

namespace petzval {

/// Chief-ray image heights [mm] at the lens's reference wavelength by object field, for the fields of a
/// request. \throws InputError naming a field that no chief ray passes at.
std::map<double, double> reference_heights_mm(const Lens& lens, const FieldTableRequest& request);

}  // namespace petzval
