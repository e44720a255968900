// SPDX-License-Identifier: BSD-3-Clause
// Pictures that scenes use as textures and as light from all around.
#pragma once

#include <string>
#include <vector>

namespace petzval::render {

/// Linear RGB (or one channel), rows from the top, channels interleaved.
struct PictureFile {
  int width = 0, height = 0, channels = 3;
  std::vector<float> values;

  const float* pixel(int column, int row) const {
    return &values[(static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                    static_cast<std::size_t>(column)) *
                   static_cast<std::size_t>(channels)];
  }
};

/// How the numbers of an 8- or 16-bit picture become linear light.
enum class PictureEncoding { by_format, srgb, linear };

/// Reads a PNG (8-bit: sRGB; 16-bit: linear, as pbrt has it, unless said otherwise), a JPEG (sRGB unless said
/// otherwise; as its samples lie, whatever Exif says of turning), an OpenEXR picture with channels R, G, B or
/// Y, or a Radiance picture (.hdr). \throws InputError if it is missing, damaged or another kind of file.
PictureFile read_picture_file(const std::string& path, PictureEncoding encoding = PictureEncoding::by_format);

}  // namespace petzval::render
