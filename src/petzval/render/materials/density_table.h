// SPDX-License-Identifier: BSD-3-Clause
// Densities over the unit square, as tables: drawn from, asked and undone.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace petzval::render {

/// A place between tables that lie on a grid of two parameters: weights of up to four of them, which sum to
/// one.
struct TableBlend {
  std::size_t count = 1;
  std::array<std::size_t, 4> table{0, 0, 0, 0};
  std::array<double, 4> weight{1, 0, 0, 0};
};

/// The nodes about a place on a rising axis, beyond its ends the last one.
struct AxisPlace {
  std::size_t first = 0;
  double part = 0;  ///< of the node after it
};
AxisPlace place_on(const std::vector<float>& axis, double value);

/// A place in the unit square, x along the rows of a table.
struct SquarePoint {
  double x = 0, y = 0;
};

/// The cell of a table with one node at each corner of the square, and the weights of its corners: (column,
/// row), (column + 1, row), then those of the row after.
struct TableCell {
  TableCell(SquarePoint at, std::size_t rows, std::size_t columns);
  std::size_t column, row;
  double x, y;  ///< within the cell
  std::array<double, 4> corners() const { return {(1 - x) * (1 - y), x * (1 - y), (1 - x) * y, x * y}; }
};

/// Tables of one size whose values, linear between nodes along both axes, are densities over the square.
/// Drawn by the marginal density of y, then by that of x at this y; a blend of tables has the blended
/// density. (Dupuy and Jakob, ACM TOG 37 (2018) 274, section 4, draws so.)
class DensityTables {
 public:
  /// \param values  [table][row][column], at least 2 × 2; each table is divided by its integral, and one
  /// without any is even.
  DensityTables(std::vector<float> values, std::size_t rows, std::size_t columns);

  double density(const TableBlend& blend, SquarePoint at) const;
  /// A point with density(), of an even one.
  SquarePoint drawn(const TableBlend& blend, SquarePoint even) const;
  /// The even point that drawn() takes to `at`.
  SquarePoint undone(const TableBlend& blend, SquarePoint at) const;

 private:
  struct Row;
  float value(std::size_t table, std::size_t row, std::size_t column) const {
    return values_[(table * rows_ + row) * columns_ + column];
  }
  template <class Of>
  double blended(const TableBlend& blend, Of&& of) const {
    double sum = 0;
    for (std::size_t i = 0; i < blend.count; ++i) sum += blend.weight[i] * of(blend.table[i]);
    return sum;
  }

  std::size_t rows_, columns_;
  std::vector<float> values_;
  std::vector<double> along_;  ///< [table][row][column]: integral of the row up to there
  std::vector<double> up_;     ///< [table][row]: integral over all rows up to there
};

}  // namespace petzval::render
