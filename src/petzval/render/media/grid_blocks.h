// SPDX-License-Identifier: BSD-3-Clause
// Rays through a box that is cut into blocks.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace petzval::render {

/// The blocks of the unit cube along a ray, one after another (Amanatides & Woo 1987).
class GridBlocks {
 public:
  /// \param count  blocks along x, y and z. \param distance  up to which the ray counts, in units of `way`.
  GridBlocks(const std::array<int, 3>& count, const std::array<double, 3>& origin,
             const std::array<double, 3>& way, double distance)
      : count_(count), end_(distance) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (way[axis] == 0) {
        if (!(origin[axis] >= 0 && origin[axis] <= 1)) end_ = -1;
        continue;
      }
      const double to_low = -origin[axis] / way[axis], to_high = (1 - origin[axis]) / way[axis];
      at_ = std::max(at_, std::min(to_low, to_high));
      end_ = std::min(end_, std::max(to_low, to_high));
    }
    if (!(at_ < end_)) return;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double place = (origin[axis] + at_ * way[axis]) * count[axis];
      block_[axis] = std::clamp(static_cast<int>(std::floor(place)), 0, count[axis] - 1);
      if (way[axis] == 0) continue;
      step_[axis] = way[axis] > 0 ? 1 : -1;
      across_[axis] = std::abs(1 / (count[axis] * way[axis]));
      next_[axis] =
          (static_cast<double>(block_[axis] + (way[axis] > 0)) / count[axis] - origin[axis]) / way[axis];
    }
  }

  bool any() const { return at_ < end_; }
  double from() const { return at_; }
  double to() const { return std::min(end_, next_[nearest()]); }
  /// Of the block, x fastest.
  std::size_t index() const {
    return (static_cast<std::size_t>(block_[2]) * static_cast<std::size_t>(count_[1]) +
            static_cast<std::size_t>(block_[1])) *
               static_cast<std::size_t>(count_[0]) +
           static_cast<std::size_t>(block_[0]);
  }
  void advance() {
    const std::size_t axis = nearest();
    at_ = std::max(at_, next_[axis]);
    next_[axis] += across_[axis];
    block_[axis] += step_[axis];
    if (block_[axis] < 0 || block_[axis] >= count_[axis]) end_ = -1;
  }

 private:
  std::size_t nearest() const {
    return static_cast<std::size_t>(std::min_element(next_.begin(), next_.end()) - next_.begin());
  }

  static constexpr double never = std::numeric_limits<double>::infinity();
  std::array<int, 3> count_, block_{}, step_{};
  std::array<double, 3> next_{never, never, never}, across_{};
  double at_ = 0, end_;
};

}  // namespace petzval::render
