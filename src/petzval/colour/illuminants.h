// SPDX-License-Identifier: BSD-3-Clause
// Lamps and daylight.
#pragma once

#include <petzval/colour/spectrum.h>

#include <span>
#include <string>
#include <vector>

namespace petzval {

/// Relative spectral power of an illuminant by name:
///   "A", "F11"                 the CIE tables (data/spectra/illuminant_*.csv)
///   "D50", "D65", "D5500" …    CIE daylight of that nominal temperature (below 1000: hundreds of kelvins)
///   "E"                        equal energy, 360 to 830 nm
///   "3200K"                    a black body
/// or the first spectrum of a file given by its path. Case matters. The scale is that of the table; D series
/// and black bodies have 100 at 560 nm. \throws InputError for anything else.
Spectrum illuminant(const std::string& name_or_path);

/// The names without a number in them that illuminant() knows.
std::vector<std::string> illuminant_names();

/// CIE daylight of a correlated colour temperature of 4000 to 25000 K, 380 to 780 nm every 5 nm, 100 at 560
/// nm. Method: CIE 15 (Judd, MacAdam & Wyszecki 1964). The names of the D series are older than today's
/// second radiation constant: D65 is daylight(6500 · 1.4388/1.4380).
Spectrum daylight(double correlated_temperature_k);

/// Spectral radiance of a black body [W·m⁻²·sr⁻¹·nm⁻¹] (Planck's law, SI constants of 2019, in vacuum).
double blackbody_radiance(double wavelength_nm, double temperature_k);
/// The same at many wavelengths. \throws InputError unless the temperature is positive.
Spectrum blackbody(double temperature_k, std::span<const double> wavelengths_nm);

}  // namespace petzval
