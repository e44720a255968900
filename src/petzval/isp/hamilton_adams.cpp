// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/isp/bayer.h>

#include <cmath>

namespace petzval {

namespace {

/// A plane with its edges mirrored.
struct MirroredPlane {
  const std::vector<float>& values;
  int columns, rows;

  float at(int row, int column) const {
    return values[static_cast<std::size_t>(mirrored(row, rows)) * static_cast<std::size_t>(columns) +
                  static_cast<std::size_t>(mirrored(column, columns))];
  }
};

/// An estimate along a line through the pixel, and how much the picture changes along it.
struct Line {
  float estimate, change;
};

/// The one along which the picture changes least; the mean of both where they are alike.
float along_the_edge(Line a, Line b) {
  if (a.change == b.change) return (a.estimate + b.estimate) / 2;
  return a.change < b.change ? a.estimate : b.estimate;
}

/// Green at a red or blue pixel, from its neighbours along (down, right) and the curvature of its own colour.
Line green_along(const MirroredPlane& raw, int row, int column, int down, int right) {
  const float before = raw.at(row - down, column - right), after = raw.at(row + down, column + right);
  const float curvature = 2 * raw.at(row, column) - raw.at(row - 2 * down, column - 2 * right) -
                          raw.at(row + 2 * down, column + 2 * right);
  return {(before + after) / 2 + curvature / 4, std::abs(before - after) + std::abs(curvature)};
}

/// Red or blue from the two neighbours along (down, right) that have it, and the curvature of green.
Line colour_along(const MirroredPlane& raw, const MirroredPlane& green, int row, int column, int down,
                  int right) {
  const float before = raw.at(row - down, column - right), after = raw.at(row + down, column + right);
  const float curvature =
      2 * green.at(row, column) - green.at(row - down, column - right) - green.at(row + down, column + right);
  return {(before + after) / 2 + curvature / 2, std::abs(before - after) + std::abs(curvature)};
}

}  // namespace

Planes bayer_hamilton_adams(const LinearMosaic& mosaic) {
  Planes planes{mosaic.columns, mosaic.rows, {3, std::vector<float>(mosaic.values.size())}};
  constexpr int red = 0, green = 1, blue = 2;
  std::vector<float>& greens = planes.values[green];
  const MirroredPlane raw{mosaic.values, mosaic.columns, mosaic.rows};
  const MirroredPlane filled{greens, mosaic.columns, mosaic.rows};
  const auto columns = static_cast<std::size_t>(mosaic.columns);
  parallel_for(static_cast<std::size_t>(mosaic.rows), [&](std::size_t line) {
    const int row = static_cast<int>(line);
    for (int column = 0; column < mosaic.columns; ++column)
      greens[line * columns + static_cast<std::size_t>(column)] =
          mosaic.mosaic.channel(row, column) == green
              ? raw.at(row, column)
              : along_the_edge(green_along(raw, row, column, 0, 1), green_along(raw, row, column, 1, 0));
  });
  parallel_for(static_cast<std::size_t>(mosaic.rows), [&](std::size_t line) {
    const int row = static_cast<int>(line);
    for (int column = 0; column < mosaic.columns; ++column) {
      const int own = mosaic.mosaic.channel(row, column);
      const std::size_t at = line * columns + static_cast<std::size_t>(column);
      // At green pixels one of the other colours lies along the row, the other along the column.
      const int in_row = mosaic.mosaic.channel(row, column + 1);
      for (const int wanted : {red, blue}) {
        float& value = planes.values[static_cast<std::size_t>(wanted)][at];
        if (own == wanted)
          value = raw.at(row, column);
        else if (own == green)
          value = wanted == in_row ? colour_along(raw, filled, row, column, 0, 1).estimate
                                   : colour_along(raw, filled, row, column, 1, 0).estimate;
        else
          value = along_the_edge(colour_along(raw, filled, row, column, 1, 1),
                                 colour_along(raw, filled, row, column, 1, -1));
      }
    }
  });
  return planes;
}

}  // namespace petzval
