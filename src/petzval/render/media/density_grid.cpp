// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/render/media/density_grid.h>

#include <algorithm>
#include <cmath>

namespace petzval::render {

namespace {

/// Along each axis: pbrt-v4 has as many.
constexpr int most_blocks = 16;
/// What is left of light is nothing below.
constexpr double least_survival = 1e-9;

Transform world_from_cube(const Transform& world_from_medium, Vector3 low, Vector3 high) {
  return world_from_medium * (Transform::translation(low) * Transform::scaling(high - low));
}

}  // namespace

DensityGrid::DensityGrid(std::array<int, 3> size, std::vector<float> values, Vector3 low, Vector3 high,
                         const Transform& world_from_medium)
    : samples_(size, std::move(values)), world_from_unit_(world_from_cube(world_from_medium, low, high)) {
  greatest_ = static_cast<double>(*std::max_element(samples_.values().begin(), samples_.values().end()));
  for (std::size_t axis = 0; axis < 3; ++axis) blocks_[axis] = std::min(size[axis], most_blocks);
  for (int z = 0; z < blocks_[2]; ++z)
    for (int y = 0; y < blocks_[1]; ++y)
      for (int x = 0; x < blocks_[0]; ++x) bounds_.push_back(static_cast<float>(bound_of({x, y, z})));
}

double DensityGrid::at(Vector3 world) const {
  const Vector3 place = world_from_unit_.inverse_point(world);
  return at_unit({place.x, place.y, place.z});
}

/// Of all samples that count inside of a block.
double DensityGrid::bound_of(std::array<int, 3> block) const {
  const GridSize& size = samples_.size();
  std::array<int, 3> first, last;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double cells = static_cast<double>(size.cells[axis]) / blocks_[axis];
    first[axis] = std::max(0, static_cast<int>(std::floor(block[axis] * cells - 0.5)));
    last[axis] =
        std::min(size.cells[axis] - 1, static_cast<int>(std::floor((block[axis] + 1) * cells - 0.5)) + 1);
  }
  double most = 0;
  for (int z = first[2]; z <= last[2]; ++z)
    for (int y = first[1]; y <= last[1]; ++y)
      for (int x = first[0]; x <= last[0]; ++x)
        most = std::max(most, static_cast<double>(samples_.values()[size.index({x, y, z})]));
  return most;
}

double DensityGrid::diagonal() const {
  double longest = 0;
  for (const Vector3 way : {Vector3{1, 1, 1}, Vector3{-1, 1, 1}, Vector3{1, -1, 1}, Vector3{1, 1, -1}})
    longest = std::max(longest, length(world_from_unit_.direction(way)));
  return longest;
}

DensityGrid::Walk DensityGrid::walk(Vector3 origin, Vector3 way, double distance, double per_density,
                                    bool stops, Lots& lots) const {
  Walk walk;
  walk.bound_depth = each_collision(origin, way, distance, per_density, lots, [&](const Collision& met) {
    ++walk.collisions;
    const double real = std::min(1.0, at_unit(met.place) / met.bound);
    if (stops && lots.next() < real) {
      walk.stopped_at = met.distance;
      return false;
    }
    walk.survived *= 1 - real;
    if (walk.survived >= least_survival) return true;
    walk.survived = 0;
    return false;
  });
  return walk;
}

}  // namespace petzval::render
