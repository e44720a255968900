// SPDX-License-Identifier: BSD-3-Clause
// Units of spectral radiance as programs and instruments spell them.
#pragma once

#include <string>
#include <string_view>

namespace petzval {

/// What a number in this unit is times to be W·m⁻²·sr⁻¹·nm⁻¹. Understood are products and quotients of W, m,
/// sr and nm with any of the prefixes n, u, µ, m, c, k and M, in any of the spellings in use:
///   W.m^-2.sr^-1.nm^-1   W/(m^2 sr nm)   W m-2 sr-1 um-1   W·m⁻²·sr⁻¹·nm⁻¹   mW/cm2/sr/um
///   W*m**-2*sr**-1*nm**-1
/// A unit of radiance without the "per wavelength" is taken per nm: spectral OpenEXR files write so.
/// \throws InputError for anything else, saying so where it is an irradiance or a luminance.
double radiance_scale(std::string_view unit);

}  // namespace petzval
