// SPDX-License-Identifier: BSD-3-Clause
// A photograph as a scene: its colours lifted to spectra.
#pragma once

#include <petzval/image/photograph.h>
#include <petzval/scene/scene.h>

#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// What a photograph does not say about itself.
struct PhotographOptions {
  PhotographEncoding encoding = PhotographEncoding::by_file;
  std::string illuminant = "D65";      ///< a name or file, as petzval::illuminant() takes it
  std::vector<double> wavelengths_nm;  ///< empty: default_bands_nm()
  double horizontal_angle_deg = 40;
  std::optional<double> distance_m;   ///< absent: at infinity
  double mean_luminance_cd_m2 = 100;  ///< over the whole spectrum, whatever wavelengths are taken from it
  std::optional<double> band_width_nm = {};  ///< as band_light() takes it
};

/// A matt picture under a light. Each pixel becomes the smooth reflectance between 0 and 1 that has its
/// colour under the illuminant, for an eye that takes the illuminant for white (ReflectanceTable::refined;
/// Jakob & Hanika 2019), as seen in the scene's own bands; where these are too few to tell colours (gaps of
/// more than 20 nm, an end within 420 to 680 nm), as seen in bands of 5 nm. Radiance is reflectance ×
/// band_light(). White, (1, 1, 1), is a perfect white. A pixel brighter than white is one of its colour
/// scaled down to white, lit by as much stronger a light. Components below 0 count as 0. Under light that
/// shows no colours (a line, an LED of one colour, near infrared) its pixels are the surfaces that have their
/// colours under D65, the level of invisible light is invisible_level(), and beyond 380 to 730 nm, which the
/// picture cannot tell of, reflectances are those of the nearer end; notes say so. \throws InputError as
/// Scene, for an unknown illuminant, one without light at the wavelengths, and for a picture that is all
/// black.
Scene photograph_scene(const Photograph& photograph, const PhotographOptions& options = {});

/// Reads a file and makes a scene of it, refusing sizes that no scene has before any spectrum is made.
Scene read_photograph_scene(const std::string& path, const PhotographOptions& options = {});

}  // namespace petzval
