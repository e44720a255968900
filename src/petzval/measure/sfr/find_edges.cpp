// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/measure/sfr/find_edges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace petzval {

namespace {

/// What lies farther from an edge changes its levels, but not what lies between them: at this distance a
/// PSF's tail changes by 1e-5 from one side of an edge to the other.
constexpr double near_px = 200;

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

/// Sets how far the edge is free on either side, over the part of it that is sampled.
void limit_reach(FoundEdge& edge) {
  const Axis axis = axis_of(edge);
  const double low = edge.sampled_from, high = edge.sampled_to;
  for (const auto& [a, b] : edge.neighbours) {
    // The part of that side abreast of this edge.
    const double ta = axis.along(a), tb = axis.along(b), da = axis.across(a), db = axis.across(b);
    if (std::max(ta, tb) < low || std::min(ta, tb) > high) continue;
    const auto across_at = [&](double t) { return da + (t - ta) / (tb - ta) * (db - da); };
    const bool end_on = ta == tb;
    for (const double d : {end_on ? da : across_at(std::clamp(ta, low, high)),
                           end_on ? db : across_at(std::clamp(tb, low, high))}) {
      if (d > 0) edge.reach_bright_px = std::min(edge.reach_bright_px, 0.6 * d);
      if (d < 0) edge.reach_dark_px = std::min(edge.reach_dark_px, -0.6 * d);
    }
  }
}

/// Samples over all of the edge, or, where it runs into another edge at one end, over the part that is free.
void choose_part(FoundEdge& edge, double greatest_reach) {
  constexpr double enough = 10;
  const double half = 0.5 * edge.length_px() - trim_of(edge);
  struct Part {
    double from = 0, to = 0, dark = 0, bright = 0;
  } best;
  double best_reach = -1;
  for (const auto& [from, to] : {std::pair{-1.0, 1.0}, {-0.3, 1.0}, {-1.0, 0.3}, {0.2, 1.0}, {-1.0, -0.2}}) {
    edge.sampled_from = from * half, edge.sampled_to = to * half;
    edge.reach_dark_px = edge.reach_bright_px = greatest_reach;
    limit_reach(edge);
    const double reach = std::min({edge.reach_dark_px, edge.reach_bright_px, enough});
    if (reach > best_reach) {
      best = {edge.sampled_from, edge.sampled_to, edge.reach_dark_px, edge.reach_bright_px};
      best_reach = reach;
    }
  }
  edge.sampled_from = best.from, edge.sampled_to = best.to;
  edge.reach_dark_px = best.dark, edge.reach_bright_px = best.bright;
}

/// The outlines of a target, as corners joined by straight lines.
struct Outline {
  std::vector<ContourPoint> corners;
  bool closed = false;
  std::size_t sides() const { return corners.size() - (closed ? 0 : 1); }
  OutlineSide side(std::size_t s) const {
    return {corners[s % corners.size()], corners[(s + 1) % corners.size()]};
  }
};

/// Sides of all outlines by where they lie, so that what is near a place is found without looking at all.
class SideGrid {
 public:
  explicit SideGrid(const std::vector<Outline>& outlines) {
    for (std::size_t o = 0; o < outlines.size(); ++o)
      for (std::size_t s = 0; s < outlines[o].sides(); ++s) {
        const OutlineSide side = outlines[o].side(s);
        // Pieces no longer than a cell, so that a long side is not taken to fill its box.
        const double length = std::hypot(side.to.x - side.from.x, side.to.y - side.from.y);
        const int pieces = 1 + static_cast<int>(length / cell_px);
        for (int i = 0; i < pieces; ++i) {
          const double share = (i + 0.5) / pieces;
          auto& cell = cells_[cell_of(side.from.x + share * (side.to.x - side.from.x),
                                      side.from.y + share * (side.to.y - side.from.y))];
          if (cell.empty() || cell.back() != std::pair{o, s}) cell.emplace_back(o, s);
        }
      }
  }
  /// Outline and side of all that come nearer than `reach_px` (and some beyond), each once, in order.
  std::vector<std::pair<std::size_t, std::size_t>> within(double reach_px, const ContourPoint& p) const {
    std::vector<std::pair<std::size_t, std::size_t>> found;
    const auto low = cell_of(p.x - reach_px - cell_px, p.y - reach_px - cell_px);
    const auto high = cell_of(p.x + reach_px + cell_px, p.y + reach_px + cell_px);
    for (int y = low.first; y <= high.first; ++y)
      for (auto at = cells_.lower_bound({y, low.second});
           at != cells_.end() && at->first <= std::pair{y, high.second}; ++at)
        found.insert(found.end(), at->second.begin(), at->second.end());
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

 private:
  static constexpr double cell_px = 64;
  static std::pair<int, int> cell_of(double x, double y) {
    return {static_cast<int>(std::floor(y / cell_px)), static_cast<int>(std::floor(x / cell_px))};
  }
  std::map<std::pair<int, int>, std::vector<std::pair<std::size_t, std::size_t>>> cells_;
};

double turn_between(const OutlineSide& a, const OutlineSide& b) {
  const double ax = a.to.x - a.from.x, ay = a.to.y - a.from.y, bx = b.to.x - b.from.x, by = b.to.y - b.from.y;
  return std::atan2(ax * by - ay * bx, ax * bx + ay * by);
}

/// Sides first … first + count − 1 of an outline, which go on into each other without a corner.
struct Stretch {
  std::size_t first = 0, count = 1;
};

std::vector<Stretch> stretches_of(const Outline& outline) {
  constexpr double smooth = 8 * pi / 180, most = 25 * pi / 180;
  const std::size_t sides = outline.sides();
  std::size_t start = 0;  // at a corner, if a closed outline has one
  if (outline.closed)
    while (start < sides &&
           std::abs(turn_between(outline.side(start + sides - 1), outline.side(start))) < smooth)
      ++start;
  if (start == sides) start = 0;
  std::vector<Stretch> stretches;
  double turned = 0;
  for (std::size_t i = 0; i < sides; ++i) {
    const std::size_t s = (start + i) % sides;
    const double turn = i == 0 ? pi : turn_between(outline.side(s + sides - 1), outline.side(s));
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

/// Standard deviation of the noise, from how far pixels lie from the mean of their neighbours to the left and
/// right.
double noise_of(const Plane& plane) {
  std::vector<double> rest;
  const std::size_t most = 100'000, pixels = plane.values.size(), step = 1 + pixels / most;
  for (std::size_t i = 1; i + 1 < pixels; i += step)
    rest.push_back(std::abs(plane.values[i] - 0.5 * (plane.values[i - 1] + plane.values[i + 1])));
  if (rest.empty()) return 0;
  const auto middle = rest.begin() + static_cast<std::ptrdiff_t>(rest.size() / 2);
  std::nth_element(rest.begin(), middle, rest.end());
  constexpr double median_of_normal = 0.6745, of_difference = 1.2247;  // √(1 + 2/4)
  return *middle / (median_of_normal * of_difference);
}

/// Every pixel the mean of itself and its neighbours, by weights 1 2 1 along both axes.
Plane smoothed(const Plane& plane) {
  Plane result = plane;
  const auto columns = static_cast<std::size_t>(plane.columns), rows = static_cast<std::size_t>(plane.rows);
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t c = 1; c + 1 < columns; ++c) {
      const double* at = plane.values.data() + r * columns + c;
      result.values[r * columns + c] = 0.25 * (at[-1] + 2 * at[0] + at[1]);
    }
  std::vector<double> above(result.values.begin(),
                            result.values.begin() + static_cast<std::ptrdiff_t>(columns));
  for (std::size_t r = 1; r + 1 < rows; ++r)
    for (std::size_t c = 0; c < columns; ++c) {
      double& here = result.values[r * columns + c];
      const double before = here;
      here = 0.25 * (above[c] + 2 * here + result.values[(r + 1) * columns + c]);
      above[c] = before;
    }
  return result;
}

/// What contours are drawn through: with noise of a hundredth of the contrast and more, smoothed.
Plane quiet(const Plane& plane) {
  const auto [low, high] = std::minmax_element(plane.values.begin(), plane.values.end());
  const double share = noise_of(plane) / std::max(1e-300, *high - *low);
  const int passes = share < 0.005 ? 0 : share < 0.02 ? 1 : share < 0.05 ? 3 : 6;
  Plane result = plane;
  for (int i = 0; i < passes; ++i) result = smoothed(result);
  return result;
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
    return (s < 0 ? -d : d) / (rho * (rho + std::abs(s)));
  };
  double sum = rest(s1) - rest(s2);
  if ((s1 < 0) != (s2 < 0)) sum += std::abs(d) > 1e-9 ? 2 / d : 0;
  return sum;
}

}  // namespace

double FoundEdge::length_px() const {
  return std::hypot(to.x - from.x, to.y - from.y);
}

EdgeLine FoundEdge::line() const {
  const Axis axis = axis_of(*this);
  EdgeLine line;
  line.centre_x = axis.middle.x, line.centre_y = axis.middle.y;
  line.normal_rad = std::atan2(axis.ux, -axis.uy);
  line.half_length = axis.half;
  return line;
}

FoundEdges find_edges(const Plane& plane, const EdgeSearchOptions& options) {
  constexpr std::size_t least_points = 24;
  constexpr double tolerance_px = 0.75, least_reach_px = 4;
  const Plane drawn = quiet(plane);
  std::vector<Outline> outlines;
  for (const LevelContour& contour : level_contours(drawn, halfway_level(drawn), least_points)) {
    std::vector<ContourPoint> corners = straightened(contour, tolerance_px);
    if (corners.size() >= 2) outlines.push_back({std::move(corners), contour.closed});
  }
  const SideGrid grid(outlines);
  FoundEdges found;
  for (std::size_t o = 0; o < outlines.size(); ++o)
    for (const Stretch& stretch : stretches_of(outlines[o])) {
      const Outline& outline = outlines[o];
      const std::size_t sides = outline.sides(), last = stretch.first + stretch.count - 1;
      FoundEdge edge;
      edge.from = outline.side(stretch.first).from, edge.to = outline.side(last % sides).to;
      edge.corner_at_from = outline.closed || stretch.first > 0;
      edge.corner_at_to = outline.closed || last + 1 < sides;
      if (edge.length_px() < options.least_length_px) continue;
      const Axis axis = axis_of(edge);
      for (const auto& [other, side] : grid.within(near_px + axis.half, axis.middle))
        if (other != o || (side + sides - stretch.first) % sides >= stretch.count)
          edge.neighbours.push_back(outlines[other].side(side));
      choose_part(edge, options.greatest_reach_px);
      if (std::min(edge.reach_dark_px, edge.reach_bright_px) >= least_reach_px)
        found.edges.push_back(std::move(edge));
    }
  if (found.edges.empty())
    throw InputError(
        fmt::format("no straight edge of at least {:g} pixels stands out in the picture; give a `roi`",
                    options.least_length_px));
  return found;
}

std::vector<EdgeSample> samples_about(const Plane& plane, const FoundEdge& edge,
                                      const PixelLattice& lattice) {
  const Axis axis = axis_of(edge);
  const double reach = std::max(edge.reach_dark_px, edge.reach_bright_px) + axis.half;
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
      const double d = axis.across(p), t = axis.along(p);
      if (t >= edge.sampled_from && t <= edge.sampled_to && d <= edge.reach_bright_px &&
          d >= -edge.reach_dark_px)
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

double missing_target_at(const FoundEdge& edge, double x, double y) {
  const ContourPoint p{x, y};
  double sum = 0;
  // ∬ r⁻³ dA = −∮ (x·n)/r³ ds, n outward: the outlines of what is bright …
  for (const OutlineSide& side : edge.neighbours) sum -= flux_through(p, side.from, side.to);
  // … minus the line of the half-plane beyond the ends of the edge.
  const Axis axis = axis_of(edge);
  const auto beyond = [&](const ContourPoint& end, double sign) -> ContourPoint {
    constexpr double far = 1e6;
    return {end.x + sign * far * axis.ux, end.y + sign * far * axis.uy};
  };
  if (edge.corner_at_from) sum += flux_through(p, beyond(edge.from, -1), edge.from);
  if (edge.corner_at_to) sum += flux_through(p, edge.to, beyond(edge.to, 1));
  return sum;
}

}  // namespace petzval
