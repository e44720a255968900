// SPDX-License-Identifier: BSD-3-Clause
// What the surfaces of a lens do to the polarisation of its light, and by that to its images.
#pragma once

#include <petzval/analysis/field_tables.h>

#include <vector>

namespace petzval {

struct PolarisationRow {
  double field = 0, wavelength_nm = 0;
  double real_image_height_mm = 0;
  double transmittance = 0;  ///< of unpolarised light, over the pupil
  /// (T_max − T_min)/(T_max + T_min) over the polarisations of one ray: its mean over the light, and the
  /// largest.
  double diattenuation = 0, largest_diattenuation = 0;
  /// How much later the slow polarisation of a ray arrives: root mean square over the light, and the largest.
  double rms_retardance_nm = 0, largest_retardance_nm = 0;
  /// The peak of a point's image in unpolarised light, by uneven transmittance and by what the polarisations
  /// differ in, over what the same light would reach without either: Σ|⟨J⟩|²/⟨Σ|J|²⟩ over the elements of
  /// the rays' Jones matrices, what both polarisations of a ray are late by (which is wavefront) taken out.
  double strehl = 1;
};

/// Rows in the order fields × wavelengths, by the Jones matrices of real rays (LensTransmittance::jones) in
/// axes that the rays carry with them. With losses that count nothing, surfaces reflect as bare glass.
/// (R. A. Chipman, W.-S. T. Lam, G. Young, Polarized Light and Optical Systems, 2018, ch. 5, 15 and 16.)
/// \throws InputError naming a field at which no ray passes.
std::vector<PolarisationRow> polarisation_table(const Lens& lens, const FieldTableRequest& request);

}  // namespace petzval
