// SPDX-License-Identifier: BSD-3-Clause
// One wavelength's light on a grid of cells: what distortion makes and blur turns into another.
#pragma once

#include <petzval/base/unset_vector.h>
#include <petzval/sensor/sensor.h>

#include <climits>
#include <cstddef>

namespace petzval {

/// Irradiance [W·m⁻²·nm⁻¹] on square cells centred on the optical axis, row-major, upright as pictures are. A
/// cell is a pixel, or one of the S × S parts of a pixel when an image is supersampled.
struct CellPlane {
  SensorGeometry grid;
  UnsetVector<float> values;

  CellPlane() = default;
  /// All zero. \throws InputError for sizes below 1, more than 2^31 cells or a pitch that is not positive.
  explicit CellPlane(const SensorGeometry& grid);
  /// The same, but holding anything: for who writes every cell.
  static CellPlane unset(const SensorGeometry& grid);

  std::size_t columns() const { return static_cast<std::size_t>(grid.columns); }
  std::size_t rows() const { return static_cast<std::size_t>(grid.rows); }
  float* row(std::size_t index) { return values.data() + index * columns(); }
  const float* row(std::size_t index) const { return values.data() + index * columns(); }
};

/// Rows [first, end).
struct RowRange {
  int first = 0, end = INT_MAX;

  bool holds(int row) const { return row >= first && row < end; }
};

/// The grid with `margin` cells more on every side (fewer if negative).
SensorGeometry grown(const SensorGeometry& grid, int margin);
/// The grid with every cell cut into factor × factor.
SensorGeometry subdivided(const SensorGeometry& grid, int factor);

}  // namespace petzval
