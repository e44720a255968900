// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/frame_zones.h>

#include <algorithm>
#include <limits>

namespace petzval {

FrameZones::FrameZones(const SensorGeometry& sensor)
    : frame_({sensor.width_mm() / 2, sensor.height_mm() / 2}) {
  for (std::size_t ring = 1; ring < rings; ++ring)
    borders_mm_[ring] = double(ring) / double(rings) * sensor.half_diagonal_mm();
  borders_mm_[rings] = std::numeric_limits<double>::infinity();
}

std::size_t FrameZones::ring_at(double height_mm) const {
  std::size_t ring = 0;
  while (ring + 1 < rings && height_mm >= borders_mm_[ring + 1]) ++ring;
  return ring;
}

std::array<double, FrameZones::rings> FrameZones::shares(double from_mm, double to_mm) const {
  std::array<double, rings> found{};
  for (std::size_t ring = 0; ring < rings; ++ring) {
    const double from = std::max(from_mm, borders_mm_[ring]), to = std::min(to_mm, borders_mm_[ring + 1]);
    if (from < to) found[ring] = frame_.share(from, to);
  }
  return found;
}

}  // namespace petzval
