// SPDX-License-Identifier: BSD-3-Clause
// A picture file as the colours that a viewer sees.
#pragma once

#include <petzval/colour/observer.h>

#include <string>
#include <vector>

namespace petzval {

/// Tristimulus values on a display whose white (D65) has Y = 1.
struct ViewedPicture {
  int columns = 0, rows = 0;
  std::vector<Xyz> pixels;  ///< row by row

  const Xyz& at(int row, int column) const {
    return pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                  static_cast<std::size_t>(column)];
  }
};

/// Reads .png and .tif of 8 and 16 bits as sRGB, grey or RGB (alpha is left aside); .tif of floating point as
/// linear sRGB. \throws InputError for other files, and as the readers.
ViewedPicture read_viewed_picture(const std::string& path);

}  // namespace petzval
