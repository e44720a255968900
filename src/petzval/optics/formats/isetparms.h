// SPDX-License-Identifier: BSD-3-Clause
// ISETPARMS.TXT: the parameters of a lens as lines of MATLAB.
#pragma once

#include <petzval/optics/formats/ray_trace_data.h>

#include <string>
#include <string_view>

namespace petzval {

/// What the file says, and where the other files are.
struct IsetParameters {
  RayTraceData data;      ///< without geometry, illumination and PSFs
  std::string base_name;  ///< of the other files, without folder
  /// Samples a side of the PSFs and their spacing, if the file gives them; 0 if not. Listings of Zemax carry
  /// their own.
  int psf_size = 0;
  double psf_spacing_um = 0;
};

/// Reads assignments `name=value` of numbers, ranges `from:step:to`, lists `[a b c]` and texts `'…'`; %
/// begins a comment. Known names: lensFile, psfSize, psfSpacing (mm), wave (nm), imgHeightNum and
/// imgHeightMax or imgHeight (mm), objDist (mm), mag, baseLensFileName, refWave (nm), fov (half, degrees),
/// efl (mm), fnumber, fnumber_eff, program; others are passed over. \param file  for messages. \throws
/// InputError with file and line.
IsetParameters read_isetparms(std::string_view text, const std::string& file);

/// The file for a structure whose heights may be anything: imgHeightNum and imgHeightMax where they are even
/// steps, as rtImportData wants them, and the list itself.
std::string isetparms_text(const RayTraceData& data, const std::string& base_name, int psf_size);

}  // namespace petzval
