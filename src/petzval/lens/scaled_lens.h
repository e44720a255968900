// SPDX-License-Identifier: BSD-3-Clause
// A lens in another size.
#pragma once

#include <petzval/lens/lens.h>

namespace petzval {

/// The lens with every length multiplied by `factor`: radii, gaps, semi-diameters, aspheres, the object's
/// distance, apertures and fields that are lengths. f-numbers, numerical apertures, angles, glasses and
/// wavelengths stay. \throws InputError unless the factor is positive and the result is a lens.
Lens scaled_lens(Lens lens, double factor);

}  // namespace petzval
