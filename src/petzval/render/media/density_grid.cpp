// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/render/media/density_grid.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval::render {

namespace {

/// Along each axis: pbrt-v4 has as many.
constexpr int most_blocks = 16;
/// What is left of light is nothing below.
constexpr double least_survival = 1e-9;

std::array<double, 3> as_array(Vector3 v) {
  return {v.x, v.y, v.z};
}

Transform world_from_cube(const Transform& world_from_medium, Vector3 low, Vector3 high) {
  return world_from_medium * (Transform::translation(low) * Transform::scaling(high - low));
}

}  // namespace

DensityGrid::DensityGrid(std::array<int, 3> size, std::vector<float> values, Vector3 low, Vector3 high,
                         const Transform& world_from_medium)
    : size_(size),
      values_(std::move(values)),
      world_from_unit_(world_from_cube(world_from_medium, low, high)) {
  for (std::size_t axis = 0; axis < 3; ++axis) blocks_[axis] = std::min(size[axis], most_blocks);
  for (int z = 0; z < blocks_[2]; ++z)
    for (int y = 0; y < blocks_[1]; ++y)
      for (int x = 0; x < blocks_[0]; ++x) bounds_.push_back(static_cast<float>(bound_of({x, y, z})));
}

double DensityGrid::value(std::array<int, 3> cell) const {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (cell[axis] < 0 || cell[axis] >= size_[axis]) return 0;
  const auto row = static_cast<std::size_t>(cell[2]) * static_cast<std::size_t>(size_[1]) +
                   static_cast<std::size_t>(cell[1]);
  return static_cast<double>(
      values_[row * static_cast<std::size_t>(size_[0]) + static_cast<std::size_t>(cell[0])]);
}

double DensityGrid::at_unit(const std::array<double, 3>& p) const {
  std::array<int, 3> cell;
  std::array<double, 3> share;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!(p[axis] >= 0 && p[axis] <= 1)) return 0;
    const double place = p[axis] * size_[axis] - 0.5;
    cell[axis] = static_cast<int>(std::floor(place));
    share[axis] = place - cell[axis];
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const std::array<int, 3> step{corner & 1, corner >> 1 & 1, corner >> 2};
    double weight = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) weight *= step[axis] ? share[axis] : 1 - share[axis];
    sum += weight * value({cell[0] + step[0], cell[1] + step[1], cell[2] + step[2]});
  }
  return sum;
}

double DensityGrid::at(Vector3 world) const {
  return at_unit(as_array(world_from_unit_.inverse_point(world)));
}

/// Of all samples that count inside of a block.
double DensityGrid::bound_of(std::array<int, 3> block) const {
  std::array<int, 3> first, last;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double cells = static_cast<double>(size_[axis]) / blocks_[axis];
    first[axis] = std::max(0, static_cast<int>(std::floor(block[axis] * cells - 0.5)));
    last[axis] = std::min(size_[axis] - 1, static_cast<int>(std::floor((block[axis] + 1) * cells - 0.5)) + 1);
  }
  double most = 0;
  for (int z = first[2]; z <= last[2]; ++z)
    for (int y = first[1]; y <= last[1]; ++y)
      for (int x = first[0]; x <= last[0]; ++x) most = std::max(most, value({x, y, z}));
  return most;
}

double DensityGrid::greatest() const {
  return static_cast<double>(*std::max_element(values_.begin(), values_.end()));
}

double DensityGrid::diagonal() const {
  double longest = 0;
  for (const Vector3 way : {Vector3{1, 1, 1}, Vector3{-1, 1, 1}, Vector3{1, -1, 1}, Vector3{1, 1, -1}})
    longest = std::max(longest, length(world_from_unit_.direction(way)));
  return longest;
}

/// The blocks along a ray, one after another (Amanatides & Woo 1987).
class DensityGrid::Blocks {
 public:
  Blocks(const std::array<int, 3>& count, const std::array<double, 3>& origin,
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

DensityGrid::Walk DensityGrid::walk(Vector3 origin, Vector3 way, double distance, double per_density,
                                    bool stops, Lots& lots) const {
  const std::array<double, 3> from = as_array(world_from_unit_.inverse_point(origin)),
                              along = as_array(world_from_unit_.inverse_direction(way));
  Walk walk;
  for (Blocks blocks(blocks_, from, along, distance); blocks.any(); blocks.advance()) {
    const auto bound = static_cast<double>(bounds_[blocks.index()]);
    if (!(bound > 0)) continue;
    const double end = blocks.to();
    for (double t = blocks.from();;) {
      const double free = per_density > 0 ? -std::log1p(-lots.next()) / (per_density * bound) : end - t;
      if (!(t + free < end)) {
        walk.bound_depth += bound * std::max(0.0, end - t);
        break;
      }
      t += free;
      walk.bound_depth += bound * free;
      ++walk.collisions;
      const double real = std::min(
          1.0, at_unit({from[0] + t * along[0], from[1] + t * along[1], from[2] + t * along[2]}) / bound);
      if (stops && lots.next() < real) {
        walk.stopped_at = t;
        return walk;
      }
      walk.survived *= 1 - real;
      if (walk.survived < least_survival) {
        walk.survived = 0;
        return walk;
      }
    }
  }
  return walk;
}

}  // namespace petzval::render
