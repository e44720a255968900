// SPDX-License-Identifier: BSD-3-Clause
// The .lens files of FlareSim and of programs descended from it.
#pragma once

#include <petzval/lens/lens_file.h>

#include <string>

namespace petzval {

/// Reads `name:`, and below `surfaces:` rows of radius, thickness, nd, Vd, semi-aperture and a number of the
/// coating, which is not read. Radius 0 or "inf" is flat, "stop" the stop. The lens is open to its stop.
/// Files that say "Converted from photonstophotos.net" have diameters in the column of semi-apertures: they
/// are read so, and a note says it. \throws InputError with file and line.
LensFile read_flaresim(const std::string& text, const std::string& file);

}  // namespace petzval
