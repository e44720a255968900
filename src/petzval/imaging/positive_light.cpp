// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/positive_light.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace petzval {

namespace {

/// Light and debts of squares of cells: where both would stand, the debt is paid from the light.
struct Level {
  std::size_t columns = 0, rows = 0;
  std::vector<double> light, debt;
};

/// The factor by which a square's light becomes less, and what is left of its debt.
double pay(double& light, double& debt) {
  if (debt <= 0) return 1;
  const double paid = std::min(light, debt);
  const double factor = light > 0 ? (light - paid) / light : 1;
  light -= paid;
  debt -= paid;
  return factor;
}

/// Squares of 2 × 2 of values; `add` puts a value, by its place, into the light and the debt of its square.
template <typename Add>
Level squares_of(std::size_t columns, std::size_t rows, const Add& add) {
  Level coarse{(columns + 1) / 2, (rows + 1) / 2, {}, {}};
  coarse.light.resize(coarse.columns * coarse.rows);
  coarse.debt.resize(coarse.light.size());
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column) {
      const std::size_t to = row / 2 * coarse.columns + column / 2;
      add(row * columns + column, coarse.light[to], coarse.debt[to]);
    }
  return coarse;
}

Level coarser(const Level& fine) {
  return squares_of(fine.columns, fine.rows, [&](std::size_t from, double& light, double& debt) {
    light += fine.light[from];
    debt += fine.debt[from];
  });
}

Level squares_of(const CellPlane& plane) {
  return squares_of(plane.columns(), plane.rows(), [&](std::size_t from, double& light, double& debt) {
    const double value = plane.values[from];
    light += std::max(0.0, value);
    debt += std::max(0.0, -value);
  });
}

}  // namespace

CellPlane without_negative_light(CellPlane plane) {
  if (std::none_of(plane.values.begin(), plane.values.end(), [](float value) { return value < 0; }))
    return plane;
  Level level = squares_of(plane);
  const std::size_t columns = level.columns, rows = level.rows;
  std::vector<double> factors(level.light.size(), 1.0);  // of the finest squares
  for (std::size_t side = 1;; side *= 2) {
    bool debts = false;
    for (std::size_t square = 0; square < level.light.size(); ++square) {
      if (level.debt[square] <= 0) continue;
      const double factor = pay(level.light[square], level.debt[square]);
      debts = debts || level.debt[square] > 0;
      const std::size_t top = square / level.columns * side, left = square % level.columns * side;
      for (std::size_t row = top; row < std::min(rows, top + side); ++row)
        for (std::size_t column = left; column < std::min(columns, left + side); ++column)
          factors[row * columns + column] *= factor;
    }
    if (!debts || level.light.size() == 1) break;
    level = coarser(level);
  }
  for (std::size_t row = 0; row < plane.rows(); ++row) {
    const double* const of_row = factors.data() + row / 2 * columns;
    float* const values = plane.row(row);
    for (std::size_t column = 0; column < plane.columns(); ++column)
      values[column] =
          values[column] > 0 ? static_cast<float>(double(values[column]) * of_row[column / 2]) : 0.0F;
  }
  return plane;
}

}  // namespace petzval
