// SPDX-License-Identifier: BSD-3-Clause
// Linear light of any three primaries.
#pragma once

#include <petzval/colour/display.h>

#include <array>

namespace petzval {

/// XYZ of linear light of red, green and blue primaries with these chromaticities, of which (1, 1, 1) is
/// display white.
ColourMatrix xyz_from_primaries(const std::array<Chromaticity, 3>& primaries);

}  // namespace petzval
