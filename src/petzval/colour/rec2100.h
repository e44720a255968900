// SPDX-License-Identifier: BSD-3-Clause
// Pictures of high dynamic range: primaries and transfer curves of ITU-R BT.2100.
#pragma once

#include <petzval/colour/display.h>

namespace petzval {

/// XYZ of linear light of the primaries of BT.2020, white D65.
const ColourMatrix& xyz_from_rec2020();

/// Luminance of diffuse white, 1 in linear light (ITU-R BT.2408) [cd/m²].
inline constexpr double hdr_white_cd_m2 = 203;

/// The inverse EOTF of SMPTE ST 2084: luminance [cd/m²], held to 0 … 10000, to code value 0 … 1.
double pq_encoded(double luminance_cd_m2);
/// Its inverse.
double pq_decoded(double encoded);

/// Hybrid log-gamma: code value, held to 0 … 1, to the light of the scene, 0 … 1 (BT.2100, table 5).
double hlg_decoded(double encoded);
/// What a display of 1000 cd/m² shows for that light of BT.2020's primaries [cd/m²]: its system gamma is 1.2.
LinearRgb hlg_displayed(LinearRgb scene);

}  // namespace petzval
