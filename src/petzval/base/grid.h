// SPDX-License-Identifier: BSD-3-Clause
// Rows and columns of values.
#pragma once

#include <petzval/base/error.h>

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace petzval {

/// Values in rows and columns, row by row from the top, one after the other in memory. Sizes and places are
/// int. Places are not checked.
template <typename T>
class Grid {
 public:
  Grid() = default;
  /// \throws InputError for sizes below 0.
  Grid(int rows, int columns, T value = {}) : Grid(rows, columns, filled(rows, columns, value)) {}
  /// \throws InputError unless there are rows × columns values.
  Grid(int rows, int columns, std::vector<T> values)
      : rows_(rows), columns_(columns), values_(std::move(values)) {
    if (rows < 0 || columns < 0 || values_.size() != count(rows, columns))
      throw InputError(std::to_string(values_.size()) + " values for a grid of " + std::to_string(columns) +
                       " x " + std::to_string(rows));
  }

  int rows() const { return rows_; }
  int columns() const { return columns_; }
  std::size_t size() const { return values_.size(); }
  bool empty() const { return values_.empty(); }

  T& at(int row, int column) { return values_[place(row) + static_cast<std::size_t>(column)]; }
  const T& at(int row, int column) const { return values_[place(row) + static_cast<std::size_t>(column)]; }
  std::span<T> row(int index) { return {values_.data() + place(index), width()}; }
  std::span<const T> row(int index) const { return {values_.data() + place(index), width()}; }

  std::vector<T>& values() { return values_; }
  const std::vector<T>& values() const { return values_; }

  bool operator==(const Grid&) const = default;

 private:
  static std::size_t count(int rows, int columns) {
    return static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
  }
  static std::vector<T> filled(int rows, int columns, T value) {
    if (rows < 0 || columns < 0) return {};  // the other constructor refuses it
    return std::vector<T>(count(rows, columns), value);
  }
  std::size_t width() const { return static_cast<std::size_t>(columns_); }
  std::size_t place(int row) const { return static_cast<std::size_t>(row) * width(); }

  int rows_ = 0, columns_ = 0;
  std::vector<T> values_;
};

}  // namespace petzval
