// SPDX-License-Identifier: BSD-3-Clause
// Lenses as plain tables of radius, thickness, index and aperture: what pbrt .dat and ISET JSON files hold.
#pragma once

#include <petzval/lens/lens_file.h>

#include <string>
#include <vector>

namespace petzval {

struct LensRow {
  double curvature_per_mm = 0;  ///< of the stop: 0
  double thickness_mm = 0;
  double index_after = 1;  ///< 0 (at the stop) means air
  double semi_diameter_mm = 0;
  bool stop = false;
};

/// Wavelengths of lenses without dispersion: the F', d and C' that such tables are published for.
inline const std::vector<double> default_wavelengths_nm{486.1327, 587.5618, 656.2725};
inline constexpr double default_reference_wavelength_nm = 587.5618;

/// The lens of these rows: opened to its stop row, for an object at infinity on the axis. A last thickness of
/// 0 means that the table does not give the image distance: the image surface is put at the paraxial focus,
/// and a note says so. The caller has checked that exactly one row is the stop. \throws InputError, with a
/// message that starts with the path of the entry.
LensFile lens_from_rows(const std::vector<LensRow>& rows);

/// The rows of a lens. \param format  for messages: "a .dat file". \throws InputError for what a row cannot
/// say: dispersion, aspheres, flat glass, a stop on glass, no clear aperture, a stop that is not opened to
/// its rim, an object at a finite distance.
std::vector<LensRow> rows_of_lens(const Lens& lens, const std::string& format);

/// "0" for the stop, else the radius with the digits that its curvature needs.
std::string row_radius_text(const LensRow& row);

}  // namespace petzval
