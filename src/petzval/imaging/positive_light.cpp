// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
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

/// Squares of 2 × 2 of a level.
Level coarser(const Level& fine) {
  Level coarse{(fine.columns + 1) / 2, (fine.rows + 1) / 2, {}, {}};
  coarse.light.resize(coarse.columns * coarse.rows);
  coarse.debt.resize(coarse.light.size());
  for (std::size_t row = 0; row < fine.rows; ++row)
    for (std::size_t column = 0; column < fine.columns; ++column) {
      const std::size_t to = row / 2 * coarse.columns + column / 2, from = row * fine.columns + column;
      coarse.light[to] += fine.light[from];
      coarse.debt[to] += fine.debt[from];
    }
  return coarse;
}

}  // namespace

CellPlane without_negative_light(CellPlane plane) {
  if (std::none_of(plane.values.begin(), plane.values.end(), [](float value) { return value < 0; }))
    return plane;
  Level level{plane.columns(), plane.rows(), {}, {}};
  level.light.reserve(plane.values.size());
  level.debt.reserve(plane.values.size());
  for (const float value : plane.values) {
    level.light.push_back(std::max(0.0, double(value)));
    level.debt.push_back(std::max(0.0, -double(value)));
  }
  std::vector<double> factors(level.light.size(), 1.0);  // of each value
  std::size_t side = 1;
  while (level.columns > 1 || level.rows > 1) {
    level = coarser(level);
    side *= 2;
    std::vector<double> of_square(level.light.size());
    bool debts = false;
    for (std::size_t square = 0; square < of_square.size(); ++square) {
      of_square[square] = pay(level.light[square], level.debt[square]);
      debts = debts || level.debt[square] > 0;
    }
    parallel_for(plane.rows(), [&](std::size_t row) {
      double* of_value = factors.data() + row * plane.columns();
      const double* of_row = of_square.data() + row / side * level.columns;
      for (std::size_t column = 0; column < plane.columns(); ++column)
        of_value[column] *= of_row[column / side];
    });
    if (!debts) break;
  }
  for (std::size_t i = 0; i < factors.size(); ++i)
    plane.values[i] = plane.values[i] > 0 ? static_cast<float>(double(plane.values[i]) * factors[i]) : 0.0F;
  return plane;
}

}  // namespace petzval
