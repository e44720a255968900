// SPDX-License-Identifier: BSD-3-Clause
// What a stack of thin films reflects and lets through.
#pragma once

#include <complex>
#include <span>

namespace petzval {

/// A film: its refractive index n − ik at the wavelength (k ≥ 0 absorbs), and how thick it is.
struct ThinFilm {
  std::complex<double> index = 1;
  double thickness_nm = 0;
};

enum class Polarisation { s, p };

/// Shares of the incident power.
struct FilmPower {
  double reflectance = 0, transmittance = 0;
};

/// Of plane waves that come from a medium without absorption, by the characteristic matrices of the films
/// (F. Abelès 1950; H. A. Macleod, Thin-Film Optical Filters, 5th ed. 2018, ch. 2). What neither is reflected
/// nor let through is absorbed in the films. \param films  in the order in which light meets them. \param
/// cosine  of the angle of incidence, in the first medium, above 0.
FilmPower film_power(double index_before, std::span<const ThinFilm> films, double index_after, double cosine,
                     double wavelength_nm, Polarisation polarisation);

/// The field behind the films over that in front, each in the root of its power: |amplitude|² is the
/// transmittance. Its phase is that of the field at the last interface against the first, light that is late
/// falling behind: e^{−2πi n d cos θ/λ} for a film that does not reflect.
std::complex<double> film_amplitude(double index_before, std::span<const ThinFilm> films, double index_after,
                                    double cosine, double wavelength_nm, Polarisation polarisation);

}  // namespace petzval
