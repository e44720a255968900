// SPDX-License-Identifier: BSD-3-Clause
// Which way up a photograph was taken.
#pragma once

#include <string_view>

namespace petzval {

/// The orientation that TIFF and Exif number 1 to 8: what the first row and the first column of the stored
/// picture are of the upright one. 1: top and left; 3: bottom and right; 6: right and top; 8: left and
/// bottom; 2, 4, 5 and 7 are mirrored.
inline constexpr int upright_orientation = 1;

/// The tag Orientation in the body of a JPEG's APP1 segment ("Exif", two zeros, then a TIFF file): Exif 2.3
/// (CIPA DC-008), section 4.6.4. `upright_orientation` for a segment without one, or one that is damaged: no
/// picture is refused for its Exif.
int exif_orientation(std::string_view app1);

}  // namespace petzval
