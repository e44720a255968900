// SPDX-License-Identifier: BSD-3-Clause
// Mosaics of known pictures.
#pragma once

#include <petzval/isp/demosaic.h>

#include <cmath>
#include <functional>
#include <string>

namespace petzval::test {

/// The value of a channel at a pixel.
using Picture = std::function<double(int channel, int row, int column)>;

inline LinearMosaic mosaic_of(int columns, int rows, const Mosaic& cells,
                              const std::vector<std::string>& names, const Picture& picture) {
  LinearMosaic mosaic{columns, rows, cells, names, {}};
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c)
      mosaic.values.push_back(static_cast<float>(picture(cells.channel(r, c), r, c)));
  return mosaic;
}

/// order: "RGGB", …
inline LinearMosaic bayer(int columns, int rows, const std::string& order, const Picture& picture) {
  Mosaic cells{2, 2, {}};
  for (const char letter : order) cells.cells.push_back(letter == 'R' ? 0 : letter == 'G' ? 1 : 2);
  return mosaic_of(columns, rows, cells, {"red", "green", "blue"}, picture);
}

/// Root of the mean square error of all planes, edges of `margin` pixels left out.
inline double rms_error(const Planes& planes, const Picture& picture, int margin) {
  double sum = 0, count = 0;
  for (std::size_t k = 0; k < planes.values.size(); ++k)
    for (int r = margin; r < planes.rows - margin; ++r)
      for (int c = margin; c < planes.columns - margin; ++c) {
        const double d =
            static_cast<double>(planes.values[k][static_cast<std::size_t>(r * planes.columns + c)]) -
            picture(static_cast<int>(k), r, c);
        sum += d * d;
        ++count;
      }
  return std::sqrt(sum / count);
}

}  // namespace petzval::test
