// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/measure/sfr/chart_mapping.h>
#include <petzval/measure/sfr/level_contours.h>
#include <petzval/measure/sfr/quiet_plane.h>
#include <petzval/target/printed_chart.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace petzval {

namespace {

struct RoundOutline {
  double x = 0, y = 0, area = 0;
};

/// Closed contours that are about as round as a circle seen at up to 60 degrees.
std::vector<RoundOutline> round_outlines(const Plane& plane) {
  constexpr std::size_t least_points = 8;
  constexpr double least_roundness = 0.7;  // 4πA/P², 1 for a circle, 0.79 for a square
  const std::optional<Plane> quieter = quiet(plane, noise_share(plane));
  const Plane& drawn = quieter ? *quieter : plane;
  std::vector<RoundOutline> outlines;
  for (const LevelContour& contour : level_contours(drawn, halfway_level(drawn), least_points)) {
    if (!contour.closed) continue;
    double twice_area = 0, moment_x = 0, moment_y = 0, way = 0;
    const ContourPoint origin = contour.points.front();
    for (std::size_t i = 0; i < contour.points.size(); ++i) {
      const ContourPoint a = contour.points[i], b = contour.points[(i + 1) % contour.points.size()];
      const double ax = a.x - origin.x, ay = a.y - origin.y, bx = b.x - origin.x, by = b.y - origin.y;
      const double cross = ax * by - bx * ay;
      twice_area += cross, moment_x += (ax + bx) * cross, moment_y += (ay + by) * cross;
      way += std::hypot(bx - ax, by - ay);
    }
    const double area = 0.5 * std::abs(twice_area);
    if (area <= 0 || 4 * pi * area < least_roundness * way * way) continue;
    outlines.push_back(
        {origin.x + moment_x / (3 * twice_area), origin.y + moment_y / (3 * twice_area), area});
  }
  return outlines;
}

struct SeenMark {
  double x = 0, y = 0, dot_share = 0, fault = 0;
};

/// Discs with a hole and a dot about the same point, the best first.
std::vector<SeenMark> seen_marks(const Plane& plane) {
  const std::vector<RoundOutline> outlines = round_outlines(plane);
  constexpr double apart = 0.12;  // of middles, over the square root of the disc's area
  std::vector<SeenMark> marks;
  for (const RoundOutline& disc : outlines) {
    const RoundOutline *hole = nullptr, *dot = nullptr;
    for (const RoundOutline& inner : outlines) {
      const double share = inner.area / disc.area;
      if (share >= 0.8 || std::hypot(inner.x - disc.x, inner.y - disc.y) > apart * std::sqrt(disc.area))
        continue;
      // Blur moves the outlines of small marks; the shares lie far apart.
      if (share > 0.35)
        hole = &inner;
      else if (share > 0.015 && share < 0.3)
        dot = &inner;
    }
    if (hole == nullptr || dot == nullptr) continue;
    const double root = std::sqrt(disc.area);
    marks.push_back({(disc.x + hole->x) / 2, (disc.y + hole->y) / 2, dot->area / disc.area,
                     std::abs(hole->area / disc.area - ChartMark::hole_share) +
                         std::hypot(hole->x - disc.x, hole->y - disc.y) / root});
  }
  std::ranges::sort(marks, {}, &SeenMark::fault);
  return marks;
}

/// The homography that takes four places to four others.
Eigen::Matrix3d homography(const std::array<ChartMark, 4>& from, const std::array<SeenMark, 4>& to) {
  Eigen::Matrix<double, 8, 8> matrix = Eigen::Matrix<double, 8, 8>::Zero();
  Eigen::Matrix<double, 8, 1> right;
  for (int i = 0; i < 4; ++i) {
    const auto [u, v] = from[static_cast<std::size_t>(i)].centre;
    const double x = to[static_cast<std::size_t>(i)].x, y = to[static_cast<std::size_t>(i)].y;
    matrix.row(2 * i) << u, v, 1, 0, 0, 0, -u * x, -v * x;
    matrix.row(2 * i + 1) << 0, 0, 0, u, v, 1, -u * y, -v * y;
    right[2 * i] = x, right[2 * i + 1] = y;
  }
  const Eigen::Matrix<double, 8, 1> h = matrix.fullPivLu().solve(right);
  Eigen::Matrix3d result;
  result << h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], 1;
  return result;
}

}  // namespace

ChartMapping::ChartMapping(const Plane& plane, double width_mm, double height_mm) {
  if (!(width_mm > 0 && height_mm > 0 && std::isfinite(width_mm) && std::isfinite(height_mm)))
    throw InputError(fmt::format("a chart of {:g} x {:g} mm: its width and height in mm, above 0, are right",
                                 width_mm, height_mm));
  std::vector<SeenMark> marks = seen_marks(plane);
  if (marks.size() < 4)
    throw InputError(
        fmt::format("{} of the chart's four marks, rings with a dot in its corners, {} seen; all of "
                    "them must be in the picture, sharp enough to tell ring and dot, and at least 20 "
                    "pixels wide",
                    marks.size(), marks.size() == 1 ? "is" : "are"));
  marks.resize(4);
  const auto first = std::ranges::max_element(marks, {}, &SeenMark::dot_share);
  double x = 0, y = 0;
  for (const SeenMark& mark : marks) x += mark.x / 4, y += mark.y / 4;
  const auto direction = [&](const SeenMark& mark) { return std::atan2(mark.y - y, mark.x - x); };
  const double start = direction(*first);
  // Clockwise in the picture, where y runs down, as the marks are on the chart.
  std::ranges::sort(marks, {}, [&](const SeenMark& mark) {
    const double turn = direction(mark) - start;
    return turn < -1e-9 ? turn + 2 * pi : turn;
  });
  std::array<SeenMark, 4> ordered;
  std::ranges::copy(marks, ordered.begin());
  picture_of_chart_ = homography(chart_marks(width_mm, height_mm), ordered);
  chart_of_picture_ = picture_of_chart_.inverse();
  if (!chart_of_picture_.allFinite()) throw InputError("the chart's four marks lie on a line");
}

std::array<double, 2> ChartMapping::on_chart(double x_px, double y_px) const {
  const Eigen::Vector3d place = chart_of_picture_ * Eigen::Vector3d(x_px, y_px, 1);
  return {place.x() / place.z(), place.y() / place.z()};
}

Eigen::Matrix2d ChartMapping::pixels_per_mm(double x_mm, double y_mm) const {
  const Eigen::Vector3d place = picture_of_chart_ * Eigen::Vector3d(x_mm, y_mm, 1);
  Eigen::Matrix2d result;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      result(i, j) = (picture_of_chart_(i, j) - place[i] / place.z() * picture_of_chart_(2, j)) / place.z();
  return result;
}

double ChartMapping::per_mm(const EdgeLine& edge) const {
  const auto [x, y] = on_chart(edge.centre_x, edge.centre_y);
  // A wave with the vector k in the picture has the vector Jᵀ k on the chart.
  return (pixels_per_mm(x, y).transpose() *
          Eigen::Vector2d(std::cos(edge.normal_rad), std::sin(edge.normal_rad)))
      .norm();
}

}  // namespace petzval
