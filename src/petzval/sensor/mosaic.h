// SPDX-License-Identifier: BSD-3-Clause
// Which channel each pixel of a sensor sees.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace petzval {

/// A block of colour filters that repeats over the sensor; its corner is the top left pixel.
struct Mosaic {
  int rows = 1, columns = 1;
  std::vector<int> cells{0};  ///< rows × columns numbers of channels, row by row

  /// The channel at a pixel, row and column from 0.
  int channel(int row, int column) const {
    return cells[static_cast<std::size_t>((row % rows) * columns + column % columns)];
  }
  bool is_uniform() const { return cells.size() == 1; }
  bool operator==(const Mosaic&) const = default;
};

/// The letters of a mosaic as the trade writes them, row by row ("RGGB"), if every name of a channel has
/// another first letter; else the names with slashes.
std::string mosaic_text(const Mosaic& mosaic, const std::vector<std::string>& channels);

}  // namespace petzval
