// SPDX-License-Identifier: BSD-3-Clause
// An ordinary picture file as linear light.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace petzval {

/// How the numbers of a picture become linear light.
enum class PhotographEncoding {
  by_file,  ///< a chunk cICP (ITU-R BT.2100, PQ or HLG: 203 cd/m² are 1), its colour profile, if it has one;
            ///< else as the file says (linear PNG, floating-point TIFF: as they are); else sRGB
  srgb,     ///< sRGB, whatever the file says
  linear    ///< linear light of sRGB's primaries
};

/// A picture in linear sRGB, upright. (1, 1, 1) is white; colours outside the gamut have components below 0
/// or above 1, and so have the lights of a floating-point picture.
struct Photograph {
  int columns = 0, rows = 0;
  std::vector<float> rgb;  ///< three a pixel, row by row from the top

  std::size_t pixels() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
  std::span<const float> row(int index) const {
    const std::size_t size = 3 * static_cast<std::size_t>(columns);
    return std::span<const float>(rgb).subspan(static_cast<std::size_t>(index) * size, size);
  }
};

/// Whether a name ends as that of a photograph does: .png, .jpg, .jpeg, .tif, .tiff.
bool has_photograph_name(const std::string& path);

/// Reads a PNG, JPEG or TIFF picture, grey or RGB, of 8 or 16 bits, TIFF of 32-bit floating point too. It is
/// turned upright as its orientation says; transparency is left aside. \throws InputError for another kind of
/// file, a damaged one, or NaN.
Photograph read_photograph(const std::string& path,
                           PhotographEncoding encoding = PhotographEncoding::by_file);

}  // namespace petzval
