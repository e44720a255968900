// SPDX-License-Identifier: BSD-3-Clause
// Wavelengths are in nm wherever a user writes them; numbers that can only be µm are not taken for nm.
#pragma once

#include <string>

namespace petzval {

/// Below it no lens lets light through and air swallows it; 0.1 to 100 µm are all the light there is.
inline constexpr double shortest_wavelength_nm = 100;

/// What is wrong with a number that is to be a wavelength of light in nm, and what would be right:
/// "wavelengths are in nm; 550 would be right for 0.55". Empty if nothing is.
std::string wavelength_fault(double nm);

/// \throws InputError with wavelength_fault(). \param what  stands before it: "`wavelengths_nm` 0.4,0.5".
void require_wavelength(double nm, const std::string& what);

}  // namespace petzval
