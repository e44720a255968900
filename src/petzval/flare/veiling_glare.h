// SPDX-License-Identifier: BSD-3-Clause
// Veiling glare: a black hole in an even surround (ISO 9358).
#pragma once

#include <petzval/flare/ghost_light.h>
#include <petzval/flare/scatter_spread.h>

#include <array>
#include <span>
#include <vector>

namespace petzval {

struct GlareOptions {
  double hole_mm = 0;        ///< diameter of the hole's image on the sensor
  double surround_deg = 60;  ///< half the angle under which the lens sees the surround, less than 80
  int across = 20;           ///< rays along a side of what a point lights of each surface
  int rings = 20;            ///< of the surround about the hole, in even steps of the angle's logarithm
  int spokes = 12;           ///< azimuths of a half of each ring, for holes off the axis
  int ghost_rings = 64;      ///< of the surround about the axis, for ghosts
  int ghost_azimuths = 12;   ///< on each of these, for lenses that are not round about the axis

  /// \throws InputError saying what would be right.
  void validate() const;
};

/// Irradiances in the middle of the image of the hole over the radiance of the surround [sr].
struct VeilingGlare {
  double scatter_sr = 0;  ///< that the lens scatters there
  double ghosts_sr = 0;   ///< that its surfaces reflect there, if that is counted
  double white_sr = 0;  ///< with no hole, but for ghosts: the image, less what is scattered, and all scatter
  double scattered_share = 0;  ///< of the light of the image

  double index() const { return (scatter_sr + ghosts_sr) / (white_sr + ghosts_sr); }
};

/// The veiling glare index of a hole whose middle is imaged at a place on the sensor: the irradiance there
/// over that without a hole (ISO 9358:1994, the integral method). The hole is a circle as the lens sees it,
/// and the surround all directions up to an angle from the axis, those that the sensor does not see among
/// them: the integral of the scatter of points of the surround (scatter_spread) over its solid angle. \param
/// g_sensor_sr  irradiance over radiance of an image without scatter (docs/CONVENTIONS.md). \throws
/// InputError as scatter_spread() and GlareOptions::validate(), and where no light is imaged.
VeilingGlare veiling_glare(const Lens& lens, const ScatterTracer& tracer, const std::array<double, 2>& at,
                           double g_sensor_sr, const GlareOptions& options);

/// Irradiance that all double reflections of an even surround have at places on the sensor, over its
/// radiance [sr], the mean over pixels as wide as the hole: ghost_light() of rings about the axis.
std::vector<double> ghost_veil(const Lens& lens, double wavelength_nm,
                               std::span<const std::array<double, 2>> places_mm, const GlareOptions& options,
                               const GhostLightOptions& how = {});

}  // namespace petzval
