// SPDX-License-Identifier: BSD-3-Clause
// The text beside an ENVI image that says what its bytes are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace petzval {

enum class EnviInterleave {
  bsq,  ///< band, row, column
  bil,  ///< row, band, column
  bip   ///< row, column, band
};

/// What of an ENVI header matters to a scene.
struct EnviHeader {
  int columns = 0, rows = 0, bands = 0;  ///< samples, lines, bands
  int data_type = 0;                     ///< 1, 2, 3, 4, 5, 12, 13, 14 or 15, as ENVI numbers them
  EnviInterleave interleave = EnviInterleave::bsq;
  bool big_endian = false;
  std::uint64_t offset = 0;            ///< bytes before the data
  std::vector<double> wavelengths_nm;  ///< in the order of the file; empty: not said
  bool wavelengths_seem_um = false;    ///< their unit is not said, and they are too small for nm
  std::vector<double> gains, offsets;  ///< radiance = gain · number + offset; empty: none
  std::vector<double> reflectance_gains, reflectance_offsets;
  std::optional<double> reflectance_scale;  ///< numbers are reflectances times this
  std::optional<double> ignored;            ///< number that stands for "no data"; may be NaN
  std::vector<bool> good;                   ///< bbl; empty: all bands
  std::string units;                        ///< `data units`, not part of ENVI's own list but in use
  std::string name;                         ///< `description` in one line

  std::size_t value_bytes() const;
  std::uint64_t data_bytes() const;
};

/// Reads "ENVI" and its "key = value" lines; a value in braces may go on over several lines, a line that
/// begins with a semicolon is a comment, keys that are not known are passed over. Wavelengths are taken in
/// nanometres, micrometres, millimetres, centimetres, metres or ångströms; without a unit, numbers below 100
/// are micrometres. (NV5 Geospatial, "ENVI Header Files".) \param file  for messages. \throws InputError with
/// file and line for what is missing, impossible or not supported: complex numbers, compression, frames.
EnviHeader parse_envi_header(std::string_view text, const std::string& file);

}  // namespace petzval
