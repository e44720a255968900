// SPDX-License-Identifier: BSD-3-Clause
// How much of the stop a field fills, which surfaces take the rest, and at what angle its light arrives.
#pragma once

#include <petzval/analysis/field_tables.h>

#include <vector>

namespace petzval {

struct VignettingRow {
  double field = 0, wavelength_nm = 0;
  double real_image_height_mm = 0;
  double open_share = 0;                 ///< area of the stop that the field's light fills, of the whole stop
  double pupil_low = 0, pupil_high = 0;  ///< ends of that area along the stop's y, in stop radii
  double pupil_half_width = 0;           ///< its largest half width along x, in stop radii
  int low_surface = -1,
      high_surface = -1;  ///< which aperture ends it there; the stop's own index for the stop
};

/// Rows in the order fields × wavelengths. Ends are good to 1e-4 of the stop radius, the half
/// width, which may lie in a corner of the outline, to 1e-2.
/// \throws InputError naming a field at which no ray passes.
std::vector<VignettingRow> vignetting_table(const Lens& lens, const FieldTableRequest& request);

struct ChiefRayAngleRow {
  double field = 0, wavelength_nm = 0;
  double object_field = 0;
  double real_image_height_mm = 0;
  /// Of the chief ray against the normal of the sensor; positive when it moves away from the axis.
  double chief_ray_angle_deg = 0;
  double mean_ray_angle_deg =
      0;  ///< of the mean direction of all light, each ray weighing as its solid angle
};

/// Rows in the order fields × wavelengths. \throws InputError naming a field at which no ray passes.
std::vector<ChiefRayAngleRow> chief_ray_angle_table(const Lens& lens, const FieldTableRequest& request);

}  // namespace petzval
