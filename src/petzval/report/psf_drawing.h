// SPDX-License-Identifier: BSD-3-Clause
// Point-spread functions as people look at them: what holds the light, all on one scale.
#pragma once

#include <petzval/wave/psf.h>

#include <string>
#include <vector>

namespace petzval {

/// Half the side of the least square about the middle of a PSF that holds this share of its light [µm].
double half_width_holding_um(const Psf& psf, double share = 0.99);

struct DrawnPsf {
  Psf psf;
  std::string caption;  ///< '\n' begins a second line
};

/// PSFs side by side, each to its own peak on a square-root scale, t upwards, cut to the square that holds 99
/// % of the light of every one, with a scale bar. \throws InputError without a PSF.
std::string psf_strip_svg(const std::vector<DrawnPsf>& psfs, int per_row);

/// The light of one wavelength from one point of the scene.
struct MappedPsf {
  Psf psf;
  double wavelength_nm = 0;
  double above_um = 0;  ///< its chief ray's height above that of the point's place: lateral colour
};

/// A place in the frame, from its middle to the right and up, and what a star makes of itself there.
struct PsfPlace {
  double x_mm = 0, y_mm = 0;
  std::vector<MappedPsf> light;
};

/// Places evenly over a frame, rows from the top, in middles of equal square cells.
std::vector<PsfPlace> even_places(double width_mm, double height_mm, int across);

/// Every star enlarged about its place, on one scale and each to its own peak (square root), t away from the
/// middle of the frame; wavelengths in their colours, which add. \throws InputError without places or light.
std::string psf_map_svg(const std::vector<PsfPlace>& places, int across, double frame_width_mm,
                        const std::string& title);

}  // namespace petzval
