// SPDX-License-Identifier: BSD-3-Clause
// Ray fans and OPD fans: transverse and wave aberration across two diameters of the pupil.
#pragma once

#include <petzval/analysis/field_tables.h>

#include <vector>

namespace petzval {

struct FanPoint {
  double pupil = 0;           ///< where the ray crosses the stop, in stop radii, −1 to 1
  double x_um = 0, y_um = 0;  ///< on the image surface, from the chief ray of the reference wavelength;
                              ///< of lenses with poses in the axes of the field, y along it
  double opd_waves = 0;       ///< W of wavefront.h, about the chief ray of its own wavelength
};

struct AberrationFans {
  double field = 0, wavelength_nm = 0;
  double real_image_height_mm = 0;
  std::vector<FanPoint> tangential;  ///< along the stop's y, in the plane of the field
  std::vector<FanPoint> sagittal;    ///< along the stop's x, through its centre
};

/// Rays at `count` even places across the stop, those that an aperture stops left out. Rows in the order
/// fields × wavelengths. \throws InputError naming a field at which no ray passes, or for a count outside 3
/// to 100001.
std::vector<AberrationFans> aberration_fans(const Lens& lens, const FieldTableRequest& request, int count);

}  // namespace petzval
