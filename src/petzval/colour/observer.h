// SPDX-License-Identifier: BSD-3-Clause
// From a spectrum to the three numbers that an eye makes of it.
#pragma once

#include <petzval/colour/spectrum.h>

#include <span>
#include <vector>

namespace petzval {

/// Tristimulus values, in the unit of ∫ value · x̄ dλ (radiometric; no 683 lm/W and no normalisation).
struct Xyz {
  double x = 0, y = 0, z = 0;

  friend Xyz operator+(Xyz a, Xyz b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Xyz operator*(double factor, Xyz a) { return {factor * a.x, factor * a.y, factor * a.z}; }
};

/// CIE chromaticity: x = X/(X+Y+Z), y = Y/(X+Y+Z).
struct Chromaticity {
  double x = 0, y = 0;
};
/// Zero for black.
Chromaticity chromaticity(Xyz colour);
/// The colour of this chromaticity with Y = 1. \throws InputError unless y > 0.
Xyz xyz_of(Chromaticity chromaticity);

/// Maximum luminous efficacy K_m [lm/W]: luminance [cd/m²] = 683 · Y of a radiance, illuminance [lx] = 683 ·
/// Y of an irradiance.
inline constexpr double lumens_per_watt = 683.0;

/// A set of three colour-matching functions.
///
///     const std::vector<Xyz> weights = Observer::cie_1931().weights(image.wavelengths_nm());
///     Xyz pixel;                                     // of spectral values e[0], e[1], …
///     for (std::size_t i = 0; i < weights.size(); ++i) pixel = pixel + e[i] * weights[i];
class Observer {
 public:
  Observer(Spectrum x_bar, Spectrum y_bar, Spectrum z_bar);
  /// The CIE 1931 2° standard observer (data/spectra/cie_1931_xyz.csv, every 1 nm from 370 to 730 nm; beyond
  /// that the standard has less than 4e-4 of X and of Y), read once per process.
  static const Observer& cie_1931();

  /// What each sample of a wavelength grid adds to X, Y, Z [nm]: the integral of the colour-matching
  /// functions times the hat function of that sample, so that any spectrum linear between the samples and
  /// zero outside them is integrated exactly, whether it has 3 or 300 samples. A single sample stands for 1
  /// nm (as band_widths_nm). \param wavelengths_nm  strictly increasing.
  std::vector<Xyz> weights(std::span<const double> wavelengths_nm) const;
  Xyz xyz(const Spectrum& spectrum) const;

 private:
  Xyz at(double wavelength_nm) const;

  Spectrum x_bar_, y_bar_, z_bar_;
};

/// Luminance [cd/m²] of a spectral radiance [W·m⁻²·sr⁻¹·nm⁻¹]; of a spectral irradiance, the illuminance
/// [lx].
double luminance(const Spectrum& radiance);

}  // namespace petzval
