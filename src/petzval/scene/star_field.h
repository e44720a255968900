// SPDX-License-Identifier: BSD-3-Clause
// The night sky as a scene.
#pragma once

#include <petzval/scene/chart_canvas.h>

#include <string>
#include <vector>

namespace petzval {

/// J2000.
struct SkyPlace {
  double right_ascension_deg = 0, declination_deg = 0;
};

struct Star {
  int hipparcos = 0;  ///< its number there
  SkyPlace place;
  double magnitude = 0;  ///< V
  double b_minus_v = 0;
};

/// What a star of V = 0 sends at 550 nm to above the atmosphere [W·m⁻²·nm⁻¹] (Bessell, Castelli & Plez 1998,
/// table A2).
inline constexpr double irradiance_of_magnitude_0 = 3.63e-11;
inline constexpr double visual_band_nm = 550;
/// Of the sky between the stars at a dark site, V in a square arcsecond.
inline constexpr double dark_sky_magnitude = 21.6;
inline constexpr double steradians_of_square_arcsecond = 2.3504430539097885e-11;

/// All stars to magnitude 6 (data/stars), the brightest first.
std::vector<Star> bright_stars();

/// Of a black body of that colour (Ballesteros 2012, eq. 14).
double star_temperature_k(double b_minus_v);

/// Above the atmosphere, of a black body that has the star's colour and its light at 550 nm [W·m⁻²·nm⁻¹].
std::vector<double> star_irradiance(const Star& star, const std::vector<double>& wavelengths_nm);

/// "orion" and others, or "RA,DEC" in degrees. \throws InputError for anything else.
SkyPlace sky_place(const std::string& text);

/// The sky around a place as the eye sees it, north up, east on the left, on a plane as wide as the options
/// say: stars at infinity in units of their own light, on a dark sky. Each star lies in the four samples
/// about it, by shares that keep its light and its place.
Scene star_field(const ChartOptions& options, SkyPlace centre);

}  // namespace petzval
