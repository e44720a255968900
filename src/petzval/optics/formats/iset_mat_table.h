// SPDX-License-Identifier: BSD-3-Clause
// ISET's `rayTrace` structure in MATLAB files.
#pragma once

#include <petzval/optics/formats/psf_grid.h>
#include <petzval/optics/formats/ray_trace_data.h>

#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// How PSFs lie in a file that does not say so itself.
struct PsfLie {
  std::optional<PsfAway> away;
  /// Row and column of the chief ray, counted from 1.
  std::optional<std::pair<int, int>> centre;
};

struct RayTraceFile {
  RayTraceData data;
  std::vector<std::string> notes;  ///< how the PSFs were taken to lie, where that was a guess
};

/// Reads a MAT file of version 5, 7 or 7.3 with a variable `optics` or `oi` (the structures of ISETCam) or
/// `rayTrace`: lensFile, program, referenceWavelength, objectDistance [mm], mag, fNumber,
/// effectiveFocalLength [mm], effectiveFNumber, fov [degrees], geometry and relIllum {fieldHeight [mm],
/// wavelength [nm], function[height × wave]}, psf {function[row, column, height, wave], fieldHeight,
/// wavelength, sampleSpacing [mm]}.
///
/// ISET turns psf.function from the direction of its columns to the azimuth of a place, so that away from the
/// axis is to the *right*, with the chief ray in row and column size/2, counted from 1; so it is taken and
/// so it is written. But what ISET itself imports from Zemax stands on end, away being up: mirror symmetric
/// PSFs tell, and are turned.
/// \throws InputError for a damaged file; missing or malformed fields; axes that differ between geometry,
/// illumination and PSFs.
RayTraceFile read_iset_mat_table(const std::string& path, const PsfLie& lie = {});

/// Writes the variable `optics`, model "raytrace", as ISETCam's oiCreate('ray trace', file) reads it; what
/// ISET has no place for is the text optics.rayTrace.petzval. \throws InputError, Failure as write_mat().
void write_iset_mat_table(const RayTraceData& data, const std::string& path);

}  // namespace petzval
