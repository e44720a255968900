// SPDX-License-Identifier: BSD-3-Clause
// A lens as people write it down: a table of radii, thicknesses, glasses and apertures.
#pragma once

#include <petzval/lens/lens_file.h>

#include <string>

namespace petzval {

/// Reads a table, a row a surface, from the object to the sensor: columns parted by commas, semicolons, tabs
/// or spaces. A line of headings says what they are (radius, thickness, glass or nd and vd, semi-diameter or
/// diameter, conic, stop; "surface" counts and says nothing); without one they are radius, thickness, glass
/// and semi-diameter. A radius that is 0, empty, "inf", "flat" or "plano" is flat, and "stop" is the stop;
/// glasses are names, "1.5168/64.17" (nd and Vd) or "1.5168" (one index), and air where there is none.
/// Lines "# f-number: 4", "# aperture: 12" (entrance pupil [mm]), "# fields: 0, 7, 10" (degrees), "#
/// wavelengths: 486, 588, 656", "# object: 400" (mm), "# name: …" and "# source: …" say the rest. What nobody
/// says is taken as usual (C, d and F; 0, 5 and 10 degrees; the first surface as the stop, open to its
/// semi-diameter; the sensor in the paraxial focus), and a note says so. \throws InputError with file and
/// line.
LensFile read_lens_table(const std::string& text, const std::string& file, const LensReadOptions& options);

/// A table to start from: a plano-convex lens of 50 mm behind its stop.
std::string lens_table_to_start_from();

}  // namespace petzval
