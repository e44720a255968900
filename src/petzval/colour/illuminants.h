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
///   "LED-B1" … "LED-V2"        the typical LEDs of CIE 015:2018 (data/spectra/cie_leds.csv)
///   "3200K"                    a black body, 200 nm to 30 um
///   "850nm", "532.1nm"         a line: a laser
///   "850nm/30"                 an LED of one colour, Gaussian, 30 nm wide at half its maximum
///   "LED-850", "LED-940"       "850nm/30" and "940nm/40": infrared LEDs as they are usual
/// or the first spectrum of a file given by its path. Case matters. The scale is that of the table; D series
/// and black bodies have 100 at 560 nm; a line has an integral of 1 value·nm, an LED a maximum of 1. \throws
/// InputError for anything else.
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
