// SPDX-License-Identifier: BSD-3-Clause
// The transfer function of a straight-edged iris, by clipping polygons.
#pragma once

#include <cmath>
#include <utility>
#include <vector>

namespace petzval::test {

/// Area of two regular polygons shifted against each other by 2s along theta, over that of one: one clipped
/// by every edge of the other in turn, then the shoelace formula.
inline double blade_otf(int blades, double rotation_deg, double s, double theta_deg) {
  using Point = std::pair<double, double>;
  const double degree = M_PI / 180;
  const auto corners = [&](double sign) {
    std::vector<Point> points;
    for (int i = 0; i < blades; ++i) {
      const double angle = rotation_deg * degree + 2 * M_PI * i / blades;
      points.emplace_back(std::cos(angle) + sign * s * std::cos(theta_deg * degree),
                          std::sin(angle) + sign * s * std::sin(theta_deg * degree));
    }
    return points;
  };
  const auto area = [](const std::vector<Point>& p) {
    double twice = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const auto& [ax, ay] = p[i];
      const auto& [bx, by] = p[(i + 1) % p.size()];
      twice += ax * by - bx * ay;
    }
    return 0.5 * twice;
  };
  std::vector<Point> left = corners(1);
  const std::vector<Point> by = corners(-1);
  for (std::size_t e = 0; e < by.size() && !left.empty(); ++e) {
    const Point &a = by[e], &b = by[(e + 1) % by.size()];
    const auto inside = [&](const Point& p) {
      return (b.first - a.first) * (p.second - a.second) - (b.second - a.second) * (p.first - a.first);
    };
    std::vector<Point> kept;
    for (std::size_t i = 0; i < left.size(); ++i) {
      const Point &p = left[i], &q = left[(i + 1) % left.size()];
      const double dp = inside(p), dq = inside(q);
      if (dp >= 0) kept.push_back(p);
      if ((dp >= 0) != (dq >= 0))
        kept.emplace_back(p.first + (q.first - p.first) * dp / (dp - dq),
                          p.second + (q.second - p.second) * dp / (dp - dq));
    }
    left = std::move(kept);
  }
  return area(left) / area(by);
}

}  // namespace petzval::test
