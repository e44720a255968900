// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/lens/surface_shape.h>
#include <petzval/report/surface_profile.h>

#include <algorithm>
#include <cmath>

namespace petzval {

std::vector<PlanePoint> profile(const Surface& surface, double vertex_z_mm, double semi_diameter_mm) {
  const auto is_closed = [&](double y) {
    return std::any_of(surface.apertures.begin(), surface.apertures.end(), [&](const ApertureFigure& figure) {
      return figure.obscures && figure.reach_sq(0, y) < 1;
    });
  };
  const bool has_holes = std::any_of(surface.apertures.begin(), surface.apertures.end(),
                                     [](const ApertureFigure& figure) { return figure.obscures; });
  const int segments = has_holes ? 256 : is_flat(surface) ? 1 : 64;
  const ShapeData<double> shape = shape_of(surface);
  std::vector<PlanePoint> points;
  for (int i = 0; i <= segments; ++i) {
    const double y = semi_diameter_mm * (2.0 * i / segments - 1);
    const double z = vertex_z_mm + surface_point(shape, 0, y).sag;
    points.push_back({has_holes && is_closed(y) ? std::nan("") : z, y});
  }
  return points;
}

std::vector<PlanePoint> placed(std::vector<PlanePoint> points, const Frame& frame, double vertex_z_mm) {
  if (frame.is_none()) return points;
  for (auto& [z, y] : points) {
    const Frame::Vector at = frame.point_to_lens({0, y, z}, vertex_z_mm);
    y = at[1], z = at[2];
  }
  return points;
}

std::vector<PlanePoint> element_outline(const std::vector<PlanePoint>& front,
                                        const std::vector<PlanePoint>& back) {
  const double top = std::max(front.back()[1], back.back()[1]),
               bottom = std::min(front.front()[1], back.front()[1]);
  std::vector<PlanePoint> outline(front);
  const auto join_at = [&](double y, double from_z, double to_z) {
    if (front.back()[0] < back.back()[0]) outline.insert(outline.end(), {{from_z, y}, {to_z, y}});
  };
  join_at(top, front.back()[0], back.back()[0]);
  outline.insert(outline.end(), back.rbegin(), back.rend());
  join_at(bottom, back.front()[0], front.front()[0]);
  return outline;
}

}  // namespace petzval
