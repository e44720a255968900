// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/render/materials/density_table.h>

#include <algorithm>
#include <cmath>

namespace petzval::render {

namespace {

/// Of a density that goes from `a` to `b` over a unit, the integral up to `x`.
double integral_to(double x, double a, double b) {
  return x * (a + x * (b - a) / 2);
}

/// Where that integral is `sum`.
double place_of(double sum, double a, double b) {
  const double root = a + std::sqrt(std::max(0.0, a * a + 2 * (b - a) * sum));
  return root > 0 ? std::clamp(2 * sum / root, 0.0, 1.0) : 0;
}

/// The last of `count` nodes but one whose rising `value` is not above `limit`.
template <class Value>
std::size_t cell_below(std::size_t count, double limit, Value&& value) {
  std::size_t low = 0, high = count - 1;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (value(middle) <= limit ? low : high) = middle;
  }
  return low;
}

std::size_t cell_of(double& at, std::size_t nodes) {
  at = std::clamp(at, 0.0, 1.0) * static_cast<double>(nodes - 1);
  const std::size_t cell = std::min(static_cast<std::size_t>(at), nodes - 2);
  at -= static_cast<double>(cell);
  return cell;
}

}  // namespace

AxisPlace place_on(const std::vector<float>& axis, double value) {
  if (axis.size() < 2) return {};
  const std::size_t i =
      cell_below(axis.size(), value, [&](std::size_t k) { return static_cast<double>(axis[k]); });
  const double from = static_cast<double>(axis[i]), to = static_cast<double>(axis[i + 1]);
  return {i, std::clamp((value - from) / (to - from), 0.0, 1.0)};
}

TableCell::TableCell(SquarePoint at, std::size_t rows, std::size_t columns) : x(at.x), y(at.y) {
  column = cell_of(x, columns);
  row = cell_of(y, rows);
}

DensityTables::DensityTables(std::vector<float> values, std::size_t rows, std::size_t columns)
    : rows_(rows), columns_(columns), values_(std::move(values)) {
  const std::size_t tables = values_.size() / (rows * columns);
  along_.resize(values_.size());
  up_.resize(tables * rows);
  const double wide = 1 / static_cast<double>(columns - 1), high = 1 / static_cast<double>(rows - 1);
  for (std::size_t t = 0; t < tables; ++t) {
    const auto table = [&](auto& of, std::size_t size) { return of.begin() + static_cast<long>(t * size); };
    const auto mean = [](auto a, auto b) { return (static_cast<double>(a) + static_cast<double>(b)) / 2; };
    const auto summed = [&] {
      for (std::size_t r = 0; r < rows; ++r) {
        const std::size_t row = (t * rows + r) * columns;
        for (std::size_t c = 1; c < columns; ++c)
          along_[row + c] = along_[row + c - 1] + wide * mean(values_[row + c - 1], values_[row + c]);
        if (r > 0)
          up_[t * rows + r] = up_[t * rows + r - 1] + high * mean(along_[row - 1], along_[row + columns - 1]);
      }
      return up_[t * rows + rows - 1];
    };
    const double all = summed();
    const auto first = table(values_, rows * columns);
    if (all > 0)
      std::for_each_n(first, rows * columns,
                      [&](float& v) { v = static_cast<float>(static_cast<double>(v) / all); });
    else
      std::fill_n(first, rows * columns, 1.0f);
    summed();
  }
}

double DensityTables::density(const TableBlend& blend, SquarePoint at) const {
  const TableCell cell(at, rows_, columns_);
  const std::array<double, 4> corner = cell.corners();
  return blended(blend, [&](std::size_t table) {
    return corner[0] * static_cast<double>(value(table, cell.row, cell.column)) +
           corner[1] * static_cast<double>(value(table, cell.row, cell.column + 1)) +
           corner[2] * static_cast<double>(value(table, cell.row + 1, cell.column)) +
           corner[3] * static_cast<double>(value(table, cell.row + 1, cell.column + 1));
  });
}

/// A blend of tables along one line of constant y.
struct DensityTables::Row {
  const DensityTables& of;
  const TableBlend& blend;
  std::size_t row;
  double y;  ///< within the cell

  template <class Field>
  double between(const Field& field, std::size_t column) const {
    return of.blended(blend, [&](std::size_t table) {
      const std::size_t at = (table * of.rows_ + row) * of.columns_ + column;
      return (1 - y) * static_cast<double>(field[at]) + y * static_cast<double>(field[at + of.columns_]);
    });
  }
  double value(std::size_t column) const { return between(of.values_, column); }
  double sum(std::size_t column) const { return between(of.along_, column); }
  double whole() const { return sum(of.columns_ - 1); }
};

SquarePoint DensityTables::drawn(const TableBlend& blend, SquarePoint even) const {
  const auto up = [&](std::size_t row) {
    return blended(blend, [&](std::size_t table) { return up_[table * rows_ + row]; });
  };
  const double wanted = even.y * up(rows_ - 1);
  const std::size_t row = cell_below(rows_, wanted, up);
  Row line{*this, blend, row, 0};
  const double below = line.whole();
  line.y = 1;
  const double above = line.whole();
  line.y = place_of((wanted - up(row)) * static_cast<double>(rows_ - 1), below, above);
  const double along = even.x * line.whole();
  const std::size_t column = cell_below(columns_, along, [&](std::size_t c) { return line.sum(c); });
  const double x = place_of((along - line.sum(column)) * static_cast<double>(columns_ - 1),
                            line.value(column), line.value(column + 1));
  return {(static_cast<double>(column) + x) / static_cast<double>(columns_ - 1),
          (static_cast<double>(row) + line.y) / static_cast<double>(rows_ - 1)};
}

SquarePoint DensityTables::undone(const TableBlend& blend, SquarePoint at) const {
  const TableCell cell(at, rows_, columns_);
  const auto up = [&](std::size_t row) {
    return blended(blend, [&](std::size_t table) { return up_[table * rows_ + row]; });
  };
  Row line{*this, blend, cell.row, 0};
  const double below = line.whole();
  line.y = 1;
  const double above = line.whole();
  line.y = cell.y;
  const double y = up(cell.row) + integral_to(cell.y, below, above) / static_cast<double>(rows_ - 1);
  const double x =
      line.sum(cell.column) + integral_to(cell.x, line.value(cell.column), line.value(cell.column + 1)) /
                                  static_cast<double>(columns_ - 1);
  const double whole = line.whole();
  return {whole > 0 ? std::min(1.0, x / whole) : at.x, std::min(1.0, y / up(rows_ - 1))};
}

}  // namespace petzval::render
