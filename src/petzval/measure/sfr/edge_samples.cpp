// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/measure/sfr/edge_samples.h>

#include <fmt/format.h>
#include <petzval/base/error.h>

#include <cmath>

namespace petzval {

std::vector<EdgeSample> samples_in(const Plane& plane, const PixelBox& box, const PixelLattice& lattice) {
  const std::string name = fmt::format("ROI {},{},{},{}", box.x, box.y, box.width, box.height);
  if (box.width < 1 || box.height < 1)
    throw InputError(name + " is empty; give x, y, width and height with a width and height of at least 1");
  if (box.x < 0 || box.y < 0 || box.width > plane.columns - box.x || box.height > plane.rows - box.y)
    throw InputError(fmt::format("{} leaves the picture of {} x {} pixels", name, plane.columns, plane.rows));
  std::vector<EdgeSample> samples;
  for (int row = box.y; row < box.y + box.height; ++row)
    for (int column = box.x; column < box.x + box.width; ++column) {
      if (column % lattice.step != lattice.column || row % lattice.step != lattice.row) continue;
      const double value = plane.at(column, row);
      if (!std::isfinite(value))
        throw InputError(
            fmt::format("{}: the value at column {}, row {} is not a finite number", name, column, row));
      samples.push_back({column + 0.5, row + 0.5, value});
    }
  constexpr std::size_t least = 64;
  if (samples.size() < least)
    throw InputError(
        fmt::format("{} holds {} pixels; an edge needs at least {}", name, samples.size(), least));
  return samples;
}

}  // namespace petzval
