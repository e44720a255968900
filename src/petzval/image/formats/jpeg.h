// SPDX-License-Identifier: BSD-3-Clause
// JPEG photographs.
#pragma once

#include <petzval/image/formats/exif_orientation.h>

#include <cstdint>
#include <string>
#include <vector>

namespace petzval {

/// A picture as it is stored; samples row by row from the top, channels interleaved.
struct JpegImage {
  int columns = 0, rows = 0;
  int channels = 3;  ///< 1 grey, 3 RGB
  std::vector<std::uint8_t> samples;
  std::string icc_profile;                ///< empty: none
  int orientation = upright_orientation;  ///< as exif_orientation() says
  /// To multiples of which the coefficients of blocks of 8 × 8 samples are rounded, row by row from the
  /// lowest frequency: of grey, or of the luma of colour pictures; empty where colours are stored as they
  /// are.
  std::vector<int> steps = {};
};

/// Reads grey and colour pictures, baseline and progressive. Nothing is allocated before the sizes have been
/// checked against the size of the file. \throws InputError for CMYK, and for damaged and truncated files.
JpegImage read_jpeg(const std::string& path);
/// The same from bytes. \param name  for messages.
JpegImage parse_jpeg(const std::string& bytes, const std::string& name);

}  // namespace petzval
