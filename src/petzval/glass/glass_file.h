// SPDX-License-Identifier: BSD-3-Clause
// Glass files of the user's own.
#pragma once

#include <petzval/glass/material.h>

#include <string>
#include <string_view>
#include <vector>

namespace petzval {

/// Glasses, and what their reader has to say of the file, one line each.
struct GlassFile {
  std::vector<Glass> glasses;
  std::vector<std::string> notes;
};

/// Reads a catalogue: an .agf file (its name is the catalogue's: "schott.agf" is SCHOTT), a .yml or .yaml
/// file of refractiveindex.info (one glass, of the catalogue USER), or a folder of such files in the order of
/// their names (the folder's name is the catalogue of its .yml files). \throws InputError with file and line.
GlassFile read_glass_files(const std::string& path);

/// The glasses of a Zemax glass catalogue (.agf) with any of its 13 dispersion formulas, valid range (LD) and
/// internal transmittance (IT); a transmittance of 0 is taken as 1e-10. Glasses whose formula is unknown are
/// left out, and a note says so. \param bytes  UTF-16, UTF-8 or Latin-1. \throws InputError
GlassFile read_agf(std::string_view bytes, const std::string& file, const std::string& catalogue);

/// One glass of refractiveindex.info (M. N. Polyanskiy): formulas 1 to 9, tabulated n, k or nk. Absolute
/// indices and vacuum wavelengths are understood where the file says so. \throws InputError
GlassFile read_glass_yaml(std::string_view bytes, const std::string& file, const std::string& catalogue,
                          const std::string& name);

}  // namespace petzval
