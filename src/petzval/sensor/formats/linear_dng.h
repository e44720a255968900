// SPDX-License-Identifier: BSD-3-Clause
// Digital negatives without a mosaic, which every program reads whatever the sensor was.
#pragma once

#include <petzval/image/camera_facts.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace petzval {

/// Linear light of three primaries, white under D65; 0 is black, for programs take no other from such files.
struct LinearPicture {
  int columns = 0, rows = 0;
  std::vector<std::uint16_t> samples = {};  ///< row by row, red, green, blue
  std::array<double, 9> rgb_from_xyz = {};  ///< row by row
  CameraFacts facts = {};
  std::string provenance = {};
};

/// Writes it as write_dng() does, LinearRaw of three samples a pixel in the mosaic's place.
/// \throws InputError for samples that do not fill it; as WholeFile; Failure.
void write_linear_dng(const std::string& path, const LinearPicture& picture);
/// The bytes of that file. \param path  for messages.
std::string linear_dng_bytes(const LinearPicture& picture, const std::string& path);

}  // namespace petzval
