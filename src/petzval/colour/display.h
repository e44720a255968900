// SPDX-License-Identifier: BSD-3-Clause
// From tristimulus values to the numbers of an sRGB picture.
#pragma once

#include <petzval/colour/observer.h>

#include <array>
#include <cstdint>

namespace petzval {

/// Linear light of the three primaries of sRGB; (1, 1, 1) is display white. Not clipped: a colour outside the
/// gamut has a component below 0, one brighter than white a component above 1.
struct LinearRgb {
  double r = 0, g = 0, b = 0;
};

/// A linear map of tristimulus values; row-major.
using ColourMatrix = std::array<std::array<double, 3>, 3>;
ColourMatrix operator*(const ColourMatrix& a, const ColourMatrix& b);
/// Of a matrix that has one.
ColourMatrix inverse(const ColourMatrix& matrix);
Xyz operator*(const ColourMatrix& matrix, Xyz colour);

/// White of sRGB and of Rec. 709: D65 as x = 0.3127, y = 0.3290 (IEC 61966-2-1), Y = 1.
Xyz display_white();

/// XYZ with display white at Y = 1 to linear sRGB, and back: from the chromaticities of the primaries
/// (0.64, 0.33), (0.30, 0.60), (0.15, 0.06) and of the white (IEC 61966-2-1).
const ColourMatrix& srgb_from_xyz();
const ColourMatrix& xyz_from_srgb();
LinearRgb linear_srgb(Xyz colour);
Xyz xyz_of(LinearRgb colour);

/// Maps colours seen under one white to the colours that look alike under another (von Kries's rule in the
/// Bradford cone space; Lam 1985, as in ICC.1:2010 annex E). `from` maps to `to` exactly. \throws InputError
/// unless both whites have positive cone responses.
ColourMatrix bradford_adaptation(Xyz from, Xyz to);

/// The sRGB transfer curve (IEC 61966-2-1), linear light 0…1 to code value 0…1 and back; odd about zero.
double srgb_encoded(double linear);
double srgb_decoded(double encoded);

/// Code values for display. What lies outside [0, 1] is clipped, each component by itself (hue may shift; no
/// gamut mapping); NaN becomes 0. Rounded to nearest.
std::uint8_t quantised_8(double value);
std::uint16_t quantised_16(double value);

}  // namespace petzval
