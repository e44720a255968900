// SPDX-License-Identifier: BSD-3-Clause
// A lens turned round.
#pragma once

#include <petzval/lens/lens.h>

namespace petzval {

/// The lens after half a turn about the y axis, its last surface in front: radii and aspheres change sign,
/// gaps and glasses their order, and poses go along. The stop is as wide as it was, fields and object are
/// those of the lens, and the sensor stands in the paraxial image. \throws InputError for surfaces of other
/// kinds than conics and aspheres, mirrors, glass before the sensor, a sensor off its place, and a lens that
/// forms no real image when it is turned round.
Lens reversed_lens(const Lens& lens);

}  // namespace petzval
