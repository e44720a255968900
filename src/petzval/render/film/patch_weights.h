// SPDX-License-Identifier: BSD-3-Clause
// How alike the surroundings of pixels are.
#pragma once

#include <petzval/render/film/pixel_window.h>

#include <functional>
#include <vector>

namespace petzval::render {

/// Planes of numbers, [plane][row][column].
struct Planes {
  int columns = 0, rows = 0, count = 0;
  std::vector<float> values;

  Planes(int width, int height, int planes)
      : columns(width),
        rows(height),
        count(planes),
        values(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
               static_cast<std::size_t>(planes)) {}
  std::size_t size() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
  std::size_t at(int plane, int row, int column) const {
    return (static_cast<std::size_t>(plane) * static_cast<std::size_t>(rows) +
            static_cast<std::size_t>(row)) *
               static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
};

/// Means over squares of 2 `radius` + 1 pixels, at the border over what is there.
Planes box_mean(const Planes& planes, int radius);

/// Calls `body` for tiles that cover a picture, on any thread; it writes to its own tile.
void for_tiles(int columns, int rows, const std::function<void(const PixelWindow&)>& body);

/// What is compared.
struct Likeness {
  const Planes& guide;
  const Planes& variance;   ///< of the guide's noise
  const Planes& tolerance;  ///< squares of differences that count in any case
  int reach = 5;            ///< neighbours so many pixels away
  int patch = 1;            ///< radius of the surroundings that are compared
  float strictness = 0.5f;  ///< k: differences count in units of k √2 standard deviations of the noise

  int side() const { return 2 * reach + 1; }
};

/// For each pixel of a tile the weights of its neighbours, [neighbour][pixel]: row by row of the square
/// around it, 0 outside of the picture; that of the pixel itself is 1.
/// (1 − d²/8)⁸, much like exp(−d²) and 0 from d² = 8 on, where d² is the mean over the patch and the guide's
/// planes of
/// ((a − b)² − (σa² + min(σa², σb²))) / (tolerance + k²(σa² + σb²)), at least 0 (Rousselle and others 2012,
/// equation 3).
std::vector<float> patch_weights(const Likeness& likeness, const PixelWindow& tile);

}  // namespace petzval::render
