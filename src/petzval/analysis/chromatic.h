// SPDX-License-Identifier: BSD-3-Clause
// Axial and lateral colour of real rays, and spherical aberration along the axis.
#pragma once

#include <petzval/analysis/field_tables.h>

#include <vector>

namespace petzval {

struct AxialFocusRow {
  double wavelength_nm = 0;
  double zone = 0;  ///< height at the stop in stop radii; 0: paraxial
  /// Where the ray of the axial object point crosses the axis, along z from the image surface; NaN where the
  /// ray does not pass. Of a lens with poses: where the rays of the two sides cross, of the smallest zone for
  /// the paraxial one.
  double focus_mm = 0;
};

/// Longitudinal aberration: rows in the order zones × wavelengths. \throws InputError for a zone outside 0 to
/// 1.
std::vector<AxialFocusRow> axial_focus_table(const Lens& lens, const std::vector<double>& wavelengths_nm,
                                             const std::vector<double>& zones,
                                             Tracer::Clip clip = Tracer::Clip::apertures);

struct LateralColourRow {
  double field = 0, wavelength_nm = 0;
  double real_image_height_mm = 0;
  double lateral_colour_um =
      0;                 ///< chief-ray height less that of the reference wavelength, same object point
  double across_um = 0;  ///< the same across the field, of lenses with poses
};

/// Rows in the order fields × wavelengths. \throws InputError naming a field that no chief ray passes at.
std::vector<LateralColourRow> lateral_colour_table(const Lens& lens, const FieldTableRequest& request);

}  // namespace petzval
