// SPDX-License-Identifier: BSD-3-Clause
// TIFF pictures of 8 or 16 bits or 32-bit floating point.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace petzval {

/// A picture; samples row by row from the top, channels interleaved.
///
///     TiffImage image{640, 480, 3, std::vector<std::uint16_t>(640 * 480 * 3)};
///     write_tiff("picture.tif", image);
struct TiffImage {
  using Samples = std::variant<std::vector<std::uint8_t>, std::vector<std::uint16_t>, std::vector<float>>;

  int columns = 0, rows = 0;
  int channels = 3;  ///< 1: grey (0 is black); 3: RGB; others: grey or RGB and what comes after it
  Samples samples;
  std::string icc_profile;  ///< its bytes; empty: none
  std::string description;  ///< how the picture came about, in ASCII; empty: none
  int orientation = 1;      ///< 1 to 8, as exif_orientation.h says; read only: 1 is written

  std::size_t sample_count() const {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows) *
           static_cast<std::size_t>(channels);
  }
};

/// Writes strips, not compressed, the same bytes for the same image: no date, no program.
/// \throws InputError if the samples do not fill the picture or a side is below 1, and as WholeFile; Failure.
void write_tiff(const std::string& path, const TiffImage& image);

/// Reads grey and RGB pictures of 8- and 16-bit whole numbers and of 32-bit floating point: strips or tiles,
/// channels interleaved or in planes, not compressed or by LZW, Deflate or PackBits. "White is zero" is
/// turned round. \throws InputError for anything else, for damaged files, and for sizes that the file cannot
/// hold.
TiffImage read_tiff(const std::string& path);

}  // namespace petzval
