// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/measure/sfr/find_edges.h>

#include <algorithm>
#include <cmath>

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
  std::vector<ContourPoint> corners;
  for (const std::size_t i : kept) corners.push_back(points[i]);
  return corners;
}

struct Axis {
  ContourPoint middle;
  double ux, uy;  ///< along
  double half;
  double along(const ContourPoint& p) const { return (p.x - middle.x) * ux + (p.y - middle.y) * uy; }
  /// Positive on the bright side: to the right of the way in the picture.
  double across(const ContourPoint& p) const { return -(p.x - middle.x) * uy + (p.y - middle.y) * ux; }
};

Axis axis_of(const FoundEdge& e) {
  const double length = e.length_px();
  return {{0.5 * (e.from.x + e.to.x), 0.5 * (e.from.y + e.to.y)},
          (e.to.x - e.from.x) / length,
          (e.to.y - e.from.y) / length,
          0.5 * length};
}

/// How far from the ends samples are taken: corners round off over the blur, and the PSF's tail looks round
/// them.
double trim_of(const FoundEdge& edge) {
  return std::clamp(0.12 * edge.length_px(), 3.0, 20.0);
}

void limit_reach(FoundEdge& edge, const TargetOutline& outline) {
  const Axis axis = axis_of(edge);
  const double half = axis.half - trim_of(edge);
  for (std::size_t o = 0; o < outline.corners.size(); ++o) {
    const auto& corners = outline.corners[o];
    const std::size_t sides = corners.size() - (outline.closed[o] ? 0 : 1);
    for (std::size_t s = 0; s < sides; ++s) {
      if (o == edge.outline && s == edge.side) continue;
      const ContourPoint &a = corners[s], &b = corners[(s + 1) % corners.size()];
      // The part of that side abreast of this edge.
      double ta = axis.along(a), tb = axis.along(b), da = axis.across(a), db = axis.across(b);
      if (std::max(ta, tb) < -half || std::min(ta, tb) > half) continue;
      for (const double end : {-half, half})
        if ((ta < end) != (tb < end)) {
          const double d = da + (end - ta) / (tb - ta) * (db - da);
          if (std::abs(ta) > half && (ta < end) == (end < 0)) ta = end, da = d;
          if (std::abs(tb) > half && (tb < end) == (end < 0)) tb = end, db = d;
        }
      for (const double d : {da, db}) {
        if (d > 0) edge.reach_bright_px = std::min(edge.reach_bright_px, 0.6 * d);
        if (d < 0) edge.reach_dark_px = std::min(edge.reach_dark_px, -0.6 * d);
      }
    }
  }
}

/// ∫ (x·n)/r³ ds along a straight line seen from p, n to the left of its way in the picture (the dark side).
double flux_through(const ContourPoint& p, const ContourPoint& a, const ContourPoint& b) {
  const double ex = b.x - a.x, ey = b.y - a.y, length = std::hypot(ex, ey);
  if (length == 0) return 0;
  const double ax = a.x - p.x, ay = a.y - p.y;
  const double d = (ax * ey - ay * ex) / length;
  const double s1 = (ax * ex + ay * ey) / length, s2 = s1 + length;
  // s/(d ρ) = sign(s) (1/d − d/(ρ(ρ + |s|))), so that nothing cancels on the line's extension.
  const auto rest = [&](double s) {
    const double rho = std::hypot(d, s);
    return std::copysign(d / (rho * (rho + std::abs(s))), s);
  };
  double sum = rest(s1) - rest(s2);
  if ((s1 < 0) != (s2 < 0)) sum += std::abs(d) > 1e-9 ? 2 / d : 0;
  return sum;
}

}  // namespace

double FoundEdge::length_px() const {
  return std::hypot(to.x - from.x, to.y - from.y);
}

FoundEdges find_edges(const Plane& plane, const EdgeSearchOptions& options) {
  constexpr std::size_t least_points = 24;
  constexpr double tolerance_px = 0.75;
  FoundEdges found;
  const double level = halfway_level(plane);
  for (const LevelContour& contour : level_contours(plane, level, least_points)) {
    std::vector<ContourPoint> corners = straightened(contour, tolerance_px);
    if (corners.size() < 2) continue;
    found.outline.corners.push_back(std::move(corners));
    found.outline.closed.push_back(contour.closed);
  }
  for (std::size_t o = 0; o < found.outline.corners.size(); ++o) {
    const auto& corners = found.outline.corners[o];
    const bool closed = found.outline.closed[o];
    const std::size_t sides = corners.size() - (closed ? 0 : 1);
    for (std::size_t s = 0; s < sides; ++s) {
      FoundEdge edge;
      edge.from = corners[s], edge.to = corners[(s + 1) % corners.size()];
      edge.corner_at_from = closed || s > 0;
      edge.corner_at_to = closed || s + 1 < sides;
      edge.outline = o, edge.side = s;
      edge.reach_dark_px = edge.reach_bright_px = options.greatest_reach_px;
      if (edge.length_px() < options.least_length_px) continue;
      limit_reach(edge, found.outline);
      if (std::min(edge.reach_dark_px, edge.reach_bright_px) >= 4) found.edges.push_back(edge);
    }
  }
  if (found.edges.empty())
    throw InputError(
        fmt::format("no straight edge of at least {:g} pixels stands out in the picture; give a --roi",
                    options.least_length_px));
  return found;
}

std::vector<EdgeSample> samples_about(const Plane& plane, const FoundEdge& edge,
                                      const PixelLattice& lattice) {
  const Axis axis = axis_of(edge);
  const double half = axis.half - trim_of(edge);
  const double reach = std::max(edge.reach_dark_px, edge.reach_bright_px) + half;
  const auto range = [&](double middle, int size) {
    return std::pair{std::clamp(static_cast<int>(middle - reach) - 1, 0, size),
                     std::clamp(static_cast<int>(middle + reach) + 2, 0, size)};
  };
  const auto [left, right] = range(axis.middle.x, plane.columns);
  const auto [top, bottom] = range(axis.middle.y, plane.rows);
  std::vector<EdgeSample> samples;
  for (int row = top; row < bottom; ++row)
    for (int column = left; column < right; ++column) {
      if (column % lattice.step != lattice.column || row % lattice.step != lattice.row) continue;
      const ContourPoint p{column + 0.5, row + 0.5};
      const double d = axis.across(p);
      if (std::abs(axis.along(p)) <= half && d <= edge.reach_bright_px && d >= -edge.reach_dark_px)
        samples.push_back({p.x, p.y, plane.at(column, row)});
    }
  return samples;
}

const FoundEdge* edge_along(const FoundEdges& found, const EdgeLine& line) {
  const FoundEdge* best = nullptr;
  double best_distance = 2;
  for (const FoundEdge& edge : found.edges) {
    const Axis axis = axis_of(edge);
    const double turn = std::remainder(std::atan2(axis.ux, -axis.uy) - line.normal_rad, 2 * pi);
    const double off = std::abs(line.distance(axis.middle.x, axis.middle.y));
    // The middle of the samples lies abreast of the edge.
    const ContourPoint centre{line.centre_x, line.centre_y};
    if (std::abs(turn) > 2 * pi / 180 || std::abs(axis.along(centre)) > axis.half || off > best_distance)
      continue;
    best = &edge, best_distance = off;
  }
  return best;
}

double missing_target_at(const FoundEdges& found, const FoundEdge& edge, double x, double y) {
  const ContourPoint p{x, y};
  double sum = 0;
  // ∬ r⁻³ dA = −∮ (x·n)/r³ ds, n outward: the outlines of what is bright …
  for (std::size_t o = 0; o < found.outline.corners.size(); ++o) {
    const auto& corners = found.outline.corners[o];
    const std::size_t sides = corners.size() - (found.outline.closed[o] ? 0 : 1);
    for (std::size_t s = 0; s < sides; ++s)
      if (o != edge.outline || s != edge.side)
        sum -= flux_through(p, corners[s], corners[(s + 1) % corners.size()]);
  }
  // … minus the line of the half-plane beyond the ends of the edge.
  constexpr double far = 1e6;
  const Axis axis = axis_of(edge);
  if (edge.corner_at_from)
    sum += flux_through(p, {edge.from.x - far * axis.ux, edge.from.y - far * axis.uy}, edge.from);
  if (edge.corner_at_to)
    sum += flux_through(p, edge.to, {edge.to.x + far * axis.ux, edge.to.y + far * axis.uy});
  return sum;
}

}  // namespace petzval
