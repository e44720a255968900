// SPDX-License-Identifier: BSD-3-Clause
// Pixels of a picture as places and values, which is all that the measurement of an edge needs.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace petzval {

/// One channel of a picture, linear in light, row-major from the top.
struct Plane {
  int columns = 0, rows = 0;
  std::vector<double> values;

  double at(int column, int row) const {
    return values[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                  static_cast<std::size_t>(column)];
  }
};

/// A rectangle of whole pixels.
struct PixelBox {
  int x = 0, y = 0, width = 0, height = 0;
};

/// The pixels of one colour of a mosaic: every `step`-th column and row from the offsets on.
struct PixelLattice {
  int step = 1, column = 0, row = 0;
};

struct EdgeSample {
  double x = 0, y = 0;  ///< of the pixel's centre [pixels]; centres are at half-integers
  double value = 0;
};

/// The samples of a plane within a box. \throws InputError if the box is empty, leaves the picture, or holds
/// fewer than 64 samples or a value that is not finite.
std::vector<EdgeSample> samples_in(const Plane& plane, const PixelBox& box, const PixelLattice& lattice = {});

}  // namespace petzval
