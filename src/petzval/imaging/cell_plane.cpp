// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/imaging/cell_plane.h>

#include <algorithm>
#include <cmath>

namespace petzval {

CellPlane CellPlane::unset(const SensorGeometry& grid) {
  constexpr double max_cells = 2147483648.0;  // 8 GB of floats
  if (grid.columns < 1 || grid.rows < 1 || !(grid.pitch_um > 0) || !std::isfinite(grid.pitch_um) ||
      double(grid.columns) * grid.rows > max_cells)
    throw InputError(fmt::format("{} × {} cells at {} µm: 1 to 2^31 cells of a positive pitch are right",
                                 grid.columns, grid.rows, grid.pitch_um));
  CellPlane plane;
  plane.grid = grid;
  plane.values.resize(plane.columns() * plane.rows());
  return plane;
}

CellPlane::CellPlane(const SensorGeometry& geometry) : CellPlane(unset(geometry)) {
  // Memory that is new to the process costs more to touch than to fill.
  parallel_for(rows(), [&](std::size_t index) { std::fill_n(row(index), columns(), 0.0F); });
}

SensorGeometry grown(const SensorGeometry& grid, int margin) {
  return {grid.columns + 2 * margin, grid.rows + 2 * margin, grid.pitch_um};
}

SensorGeometry subdivided(const SensorGeometry& grid, int factor) {
  return {grid.columns * factor, grid.rows * factor, grid.pitch_um / factor};
}

}  // namespace petzval
