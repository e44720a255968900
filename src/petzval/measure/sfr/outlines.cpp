// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/measure/sfr/outlines.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace petzval {

namespace {

double distance_to_chord(const ContourPoint& p, const ContourPoint& a, const ContourPoint& b) {
  const double ex = b.x - a.x, ey = b.y - a.y, length = std::hypot(ex, ey);
  if (length == 0) return std::hypot(p.x - a.x, p.y - a.y);
  return std::abs((p.x - a.x) * ey - (p.y - a.y) * ex) / length;
}

/// Indices of the points that stay, between first and last.
void divide(const std::vector<ContourPoint>& points, std::size_t first, std::size_t last, double tolerance,
            std::vector<std::size_t>& kept) {
  // Iterative, for contours of any length.
  std::vector<std::pair<std::size_t, std::size_t>> open{{first, last}};
  while (!open.empty()) {
    const auto [a, b] = open.back();
    open.pop_back();
    double worst = 0;
    std::size_t at = a;
    for (std::size_t i = a + 1; i < b; ++i) {
      const double d = distance_to_chord(points[i], points[a], points[b]);
      if (d > worst) worst = d, at = i;
    }
    if (worst <= tolerance) continue;
    kept.push_back(at);
    open.push_back({a, at});
    open.push_back({at, b});
  }
}

/// A line through the middle of a stretch of points: a point and a direction. Nothing for short stretches.
struct Fitted {
  ContourPoint at;
  double ux = 0, uy = 0;
};

std::optional<Fitted> line_through(const std::vector<ContourPoint>& points, std::size_t first,
                                   std::size_t last) {
  constexpr std::size_t least = 16;
  if (last < first + least) return std::nullopt;
  const std::size_t trim = (last - first) / 6;
  Fitted line;
  double n = 0, xx = 0, xy = 0, yy = 0;
  for (std::size_t i = first + trim; i <= last - trim; ++i)
    n += 1, line.at.x += points[i].x, line.at.y += points[i].y;
  line.at.x /= n, line.at.y /= n;
  for (std::size_t i = first + trim; i <= last - trim; ++i) {
    const double x = points[i].x - line.at.x, y = points[i].y - line.at.y;
    xx += x * x, xy += x * y, yy += y * y;
  }
  const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
  line.ux = std::cos(angle), line.uy = std::sin(angle);
  return line;
}

/// The corners of a contour: where the lines through its stretches meet, since blur has rounded the contour
/// itself.
std::vector<ContourPoint> sharpened(const std::vector<ContourPoint>& points,
                                    const std::vector<std::size_t>& kept, bool closed) {
  const std::size_t sides = closed ? kept.size() : kept.size() - 1;
  std::vector<std::optional<Fitted>> lines;
  for (std::size_t s = 0; s < sides; ++s)
    lines.push_back(line_through(points, kept[s], s + 1 < kept.size() ? kept[s + 1] : points.size() - 1));
  // Blur cuts corners: a short stretch between two straight ones stands for the corner where these meet.
  const auto meeting_of = [&](std::size_t before, std::size_t after,
                              const ContourPoint& near) -> std::optional<ContourPoint> {
    const std::optional<Fitted>&a = lines[before % sides], &b = lines[after % sides];
    if (!a || !b) return std::nullopt;
    const double turn = a->ux * b->uy - a->uy * b->ux;
    if (std::abs(turn) < 0.25) return std::nullopt;
    const double t = ((b->at.x - a->at.x) * b->uy - (b->at.y - a->at.y) * b->ux) / turn;
    const ContourPoint meeting{a->at.x + t * a->ux, a->at.y + t * a->uy};
    constexpr double farthest = 40;  // lines that meet farther away than any blur's rounding make no corner
    if (std::hypot(meeting.x - near.x, meeting.y - near.y) > farthest) return std::nullopt;
    return meeting;
  };
  std::vector<ContourPoint> corners;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const ContourPoint corner = points[kept[i]];
    const bool inner = closed || (i > 0 && i + 1 < kept.size());
    const std::size_t before = i + sides - 1;  // the side that ends here; side i begins here
    if (inner && i < sides && !lines[i]) {
      // This corner and the next are one, if the sides beyond them meet; the next then falls to the branch
      // below.
      if (const auto meeting = meeting_of(before, i + 1, corner);
          meeting && (closed || i + 2 < kept.size())) {
        corners.push_back(*meeting);
        continue;
      }
    }
    if (inner && !lines[before % sides] && meeting_of(before + sides - 1, i, corner) && (closed || i > 1))
      continue;
    const auto meeting = inner ? meeting_of(before, i, corner) : std::nullopt;
    corners.push_back(meeting.value_or(corner));
  }
  return corners;
}

double turn_between(const OutlineSide& a, const OutlineSide& b) {
  const double ax = a.to.x - a.from.x, ay = a.to.y - a.from.y, bx = b.to.x - b.from.x, by = b.to.y - b.from.y;
  return std::atan2(ax * by - ay * bx, ax * bx + ay * by);
}

}  // namespace

std::vector<ContourPoint> straightened(const LevelContour& contour, double tolerance) {
  std::vector<ContourPoint> points = contour.points;
  std::vector<std::size_t> kept;
  if (contour.closed) {
    // Start at a corner: the point farthest from the first, and from there the farthest again.
    const auto farthest = [&](std::size_t from) {
      std::size_t best = 0;
      for (std::size_t i = 0; i < points.size(); ++i)
        if (std::hypot(points[i].x - points[from].x, points[i].y - points[from].y) >
            std::hypot(points[best].x - points[from].x, points[best].y - points[from].y))
          best = i;
      return best;
    };
    std::rotate(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(farthest(0)), points.end());
    const std::size_t opposite = farthest(0);
    points.push_back(points.front());
    kept = {0, opposite};
    divide(points, 0, opposite, tolerance, kept);
    divide(points, opposite, points.size() - 1, tolerance, kept);
  } else {
    kept = {0, points.size() - 1};
    divide(points, 0, points.size() - 1, tolerance, kept);
  }
  std::sort(kept.begin(), kept.end());
  return sharpened(points, kept, contour.closed);
}

std::vector<Stretch> stretches_of(const TargetOutline& outline) {
  constexpr double smooth = 8 * pi / 180, most = 25 * pi / 180;
  const std::size_t sides = outline.sides();
  const auto turn_before = [&](std::size_t side) {
    return turn_between(outline.side((side + sides - 1) % sides), outline.side(side));
  };
  std::size_t start = 0;  // at a corner, if a closed outline has one
  if (outline.closed)
    while (start < sides && std::abs(turn_before(start)) < smooth) ++start;
  if (start == sides) start = 0;
  std::vector<Stretch> stretches;
  double turned = 0;
  for (std::size_t i = 0; i < sides; ++i) {
    const std::size_t s = (start + i) % sides;
    const double turn = i == 0 ? pi : turn_before(s);
    turned += turn;
    if (i > 0 && std::abs(turn) < smooth && std::abs(turned) < most) {
      ++stretches.back().count;
    } else {
      stretches.push_back({s, 1});
      turned = 0;
    }
  }
  return stretches;
}

}  // namespace petzval
