// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/lens/surface_shape.h>
#include <petzval/report/surface_profile.h>

#include <algorithm>

namespace petzval {

std::vector<PlanePoint> profile(const Surface& surface, double vertex_z_mm, double semi_diameter_mm) {
  const int segments = is_flat(surface) ? 1 : 64;
  const ShapeData<double> shape = shape_of(surface);
  std::vector<PlanePoint> points;
  for (int i = 0; i <= segments; ++i) {
    const double y = semi_diameter_mm * (2.0 * i / segments - 1);
    points.push_back({vertex_z_mm + surface_point(shape, 0, y).sag, y});
  }
  return points;
}

std::vector<PlanePoint> element_outline(const std::vector<PlanePoint>& front,
                                        const std::vector<PlanePoint>& back) {
  const double front_y = front.back()[1], back_y = back.back()[1];
  const double front_z = front.back()[0], back_z = back.back()[0];
  const double rim_y = std::max(front_y, back_y);
  std::vector<PlanePoint> outline(front);
  const bool cylinder = front_z < back_z;
  if (cylinder) outline.insert(outline.end(), {{front_z, rim_y}, {back_z, rim_y}});
  outline.insert(outline.end(), back.rbegin(), back.rend());
  if (cylinder) outline.insert(outline.end(), {{back_z, -rim_y}, {front_z, -rim_y}});
  return outline;
}

}  // namespace petzval
