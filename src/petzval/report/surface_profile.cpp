// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/report/surface_profile.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval {

double profile_sag_mm(const Surface& surface, double y_mm) {
  const double c = surface.curvature_per_mm, r2 = y_mm * y_mm;
  const double root = std::sqrt(1 - (1 + surface.conic) * c * c * r2);  // NaN beyond the rim
  double sag = c * r2 / (1 + root);
  for (const auto& [power, coefficient] : surface.asphere)
    sag += coefficient * std::pow(std::abs(y_mm), power);
  return sag;
}

double profile_rim_mm(const Surface& surface) {
  const double squared = (1 + surface.conic) * surface.curvature_per_mm * surface.curvature_per_mm;
  return squared > 0 ? 1 / std::sqrt(squared) : std::numeric_limits<double>::infinity();
}

std::vector<PlanePoint> profile(const Surface& surface, double vertex_z_mm, double semi_diameter_mm) {
  const int segments = surface.is_flat() ? 1 : 64;
  std::vector<PlanePoint> points;
  for (int i = 0; i <= segments; ++i) {
    const double y = semi_diameter_mm * (2.0 * i / segments - 1);
    points.push_back({vertex_z_mm + profile_sag_mm(surface, y), y});
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
