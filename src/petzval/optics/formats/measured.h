// SPDX-License-Identifier: BSD-3-Clause
// Measurements of a real lens, PSFs or MTFs, as CSV files.
#pragma once

#include <petzval/optics/formats/number_columns.h>
#include <petzval/optics/formats/ray_trace_data.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace petzval {

struct MeasuredFile {
  RayTraceData data;
  std::vector<std::string> notes;  ///< what had to be assumed, and how well a model meets the measurement
};

struct MeasuredOptions {
  /// Noise below zero becomes zero; else it is refused.
  bool clip_negative = false;
};

/// Comment lines of either kind of file: `# focal_length_mm:` (needed), `# f_number:`, `# name:`,
/// `# object_distance_mm:` and `# magnification:` (a finite object), `# reference_wavelength_nm:`. `field_mm`
/// is the distance from the axis on the sensor; every field, from 0 on, needs every wavelength.
///
/// With columns field_mm, wavelength_nm, x_mm, y_mm, value: PSFs. y points away from the axis, x a quarter
/// turn clockwise from it (to the right where y is up), both from the point at field_mm. Samples of one PSF
/// fill a square grid; a point at (0, 0) need not be among them. Any unit of light.
///
/// With columns field_mm, wavelength_nm, frequency_cpmm, tangential, sagittal: MTFs, from which psf_of_mtf()
/// makes PSFs.
/// \param curves  CSV text of columns field_mm and paraxial_height_mm (distortion) or relative_illumination
/// or both, for all wavelengths; empty: no distortion, even illumination. \param file, curves_file  for
/// messages. \throws InputError with file and line.
MeasuredFile read_measured(std::string_view text, const std::string& file, std::string_view curves,
                           const std::string& curves_file, const MeasuredOptions& options = {});

}  // namespace petzval
