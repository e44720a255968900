// SPDX-License-Identifier: BSD-3-Clause
// PNG pictures of 8 or 16 bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace petzval {

/// What the sample values mean, as far as the file says.
enum class PngTransfer {
  unstated,
  srgb,
  linear,
  rec2100_pq,   ///< ITU-R BT.2100, perceptual quantisation, by a chunk cICP
  rec2100_hlg,  ///< ITU-R BT.2100, hybrid log-gamma, by a chunk cICP
  other         ///< stated by a chunk cICP; read, not written
};

/// Everything of a PNG picture but its samples.
struct PngLayout {
  int columns = 0, rows = 0;
  int channels = 3;  ///< 1 grey, 2 grey and alpha, 3 RGB, 4 RGB and alpha
  int bits = 8;      ///< 8 or 16
  PngTransfer transfer = PngTransfer::srgb;
  std::string icc_profile{};                ///< written in place of `transfer` if it is there
  std::string exif{};                       ///< from its TIFF header on; written, not read
  std::map<std::string, std::string> text;  ///< Latin-1 keyword of 1 to 79 characters → UTF-8 text

  std::size_t row_samples() const {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(channels);
  }
};

/// A picture; samples row by row from the top, channels interleaved, 0 to 255 or 0 to 65535.
struct PngImage : PngLayout {
  std::vector<std::uint16_t> samples;
};

/// Fills one row of samples.
using PngRowSource = std::function<void(int row, std::span<std::uint16_t> samples)>;

/// Writes a picture row by row. The bytes depend on the arguments alone: no time stamp is written.
/// \throws InputError for a layout that PNG does not have, or as WholeFile; Failure; what `row_source`
/// throws.
void write_png(const std::string& path, const PngLayout& layout, const PngRowSource& row_source);
void write_png(const std::string& path, const PngImage& image);

/// Reads grey, RGB and palette pictures with or without alpha; palettes and transparent colours are resolved,
/// fewer than 8 bits become 8. Nothing is allocated before the sizes have been checked against the size of
/// the file. \throws InputError for anything that is not a sound PNG.
PngImage read_png(const std::string& path);
/// The same of standard dynamic range: sRGB, linear light, or not stated. \throws InputError for others.
PngImage read_standard_png(const std::string& path);
/// The same as read_png() from bytes. \param name  for messages.
PngImage parse_png(std::string bytes, const std::string& name);

}  // namespace petzval
