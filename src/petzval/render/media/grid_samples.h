// SPDX-License-Identifier: BSD-3-Clause
// Samples that fill a box.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace petzval::render {

/// A place in a box whose corners are 0 and 1.
using UnitPlace = std::array<double, 3>;

/// How many cells fill a box along x, y and z, and the samples at their centres.
struct GridSize {
  std::array<int, 3> cells;

  bool has(const std::array<int, 3>& cell) const {
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (cell[axis] < 0 || cell[axis] >= cells[axis]) return false;
    return true;
  }
  /// Of a sample, x fastest.
  std::size_t index(const std::array<int, 3>& cell) const {
    const auto row = static_cast<std::size_t>(cell[2]) * static_cast<std::size_t>(cells[1]) +
                     static_cast<std::size_t>(cell[1]);
    return row * static_cast<std::size_t>(cells[0]) + static_cast<std::size_t>(cell[0]);
  }
  /// visit(index, weight) for the samples about a place, with straight lines between them that fall to 0 half
  /// a cell outside of the outermost; none outside of the box.
  template <class Visit>
  void each_about(const UnitPlace& p, Visit&& visit) const {
    std::array<int, 3> cell;
    std::array<double, 3> share;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!(p[axis] >= 0 && p[axis] <= 1)) return;
      const double place = p[axis] * cells[axis] - 0.5;
      cell[axis] = static_cast<int>(std::floor(place));
      share[axis] = place - cell[axis];
    }
    for (int corner = 0; corner < 8; ++corner) {
      const std::array<int, 3> step{corner & 1, corner >> 1 & 1, corner >> 2};
      const std::array<int, 3> at{cell[0] + step[0], cell[1] + step[1], cell[2] + step[2]};
      if (!has(at)) continue;
      double weight = 1;
      for (std::size_t axis = 0; axis < 3; ++axis) weight *= step[axis] ? share[axis] : 1 - share[axis];
      visit(index(at), weight);
    }
  }
};

/// A number at each of them.
class GridSamples {
 public:
  /// \param values  x fastest.
  GridSamples(const std::array<int, 3>& cells, std::vector<float> values)
      : size_{cells}, values_(std::move(values)) {}

  const GridSize& size() const { return size_; }
  const std::vector<float>& values() const { return values_; }
  double at(const UnitPlace& place) const {
    double sum = 0;
    size_.each_about(place, [&](std::size_t index, double weight) {
      sum += weight * static_cast<double>(values_[index]);
    });
    return sum;
  }

 private:
  GridSize size_;
  std::vector<float> values_;
};

}  // namespace petzval::render
