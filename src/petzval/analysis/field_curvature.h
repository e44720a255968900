// SPDX-License-Identifier: BSD-3-Clause
// Where the narrow bundle about the chief ray comes to its two foci.
#pragma once

#include <petzval/analysis/field_tables.h>
#include <petzval/analysis/field_tracer.h>

#include <vector>

namespace petzval {

/// Distances [mm] along the chief ray from its image point to the foci of the rays next to it, positive in
/// the direction of the light; ±infinite for a bundle that leaves parallel.
struct AstigmaticFoci {
  double tangential_mm = 0;  ///< of rays in the plane of the field
  double sagittal_mm = 0;    ///< of rays beside it
};

/// Coddington's equations along the real chief ray, surface by surface, with the principal curvatures of the
/// surface where the ray meets it. (Welford, Aberrations of Optical Systems, 1986, section 9.2; Kingslake &
/// Johnson, Lens Design Fundamentals, 2010, section 11.1.) Of lenses with poses, ray transfers and ideal
/// lenses, where real rays close beside the chief ray cross, in the plane of the field and beside it.
AstigmaticFoci astigmatic_foci(const FieldTracer& tracer, const ChiefRay& chief);

struct FieldCurvatureRow {
  double field = 0, wavelength_nm = 0;
  double object_field = 0;
  double real_image_height_mm = 0;
  double tangential_mm = 0, sagittal_mm = 0;  ///< along z from the image surface, positive behind it
  double petzval_mm = 0;  ///< NaN of lenses with poses: the Petzval parabola through the paraxial focus, at
                          ///< the paraxial image height
};

/// Rows in the order fields × wavelengths. \throws InputError naming a field that no chief ray passes at.
std::vector<FieldCurvatureRow> field_curvature_table(const Lens& lens, const FieldTableRequest& request);

}  // namespace petzval
