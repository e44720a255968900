// SPDX-License-Identifier: BSD-3-Clause
// A rectangle of a picture.
#pragma once

#include <cstddef>

namespace petzval::render {

/// Pixels [left, right) × [top, bottom) of a picture.
struct PixelWindow {
  int left = 0, top = 0, right = 0, bottom = 0;

  friend bool operator==(const PixelWindow&, const PixelWindow&) = default;
  int columns() const { return right - left; }
  int rows() const { return bottom - top; }
  std::size_t size() const { return static_cast<std::size_t>(columns()) * static_cast<std::size_t>(rows()); }
  bool contains(int column, int row) const {
    return column >= left && column < right && row >= top && row < bottom;
  }
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row - top) * static_cast<std::size_t>(columns()) +
           static_cast<std::size_t>(column - left);
  }
};

}  // namespace petzval::render
