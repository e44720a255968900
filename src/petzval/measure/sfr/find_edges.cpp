// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/measure/sfr/find_edges.h>
#include <petzval/measure/sfr/outlines.h>
#include <petzval/measure/sfr/quiet_plane.h>

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
/// them. What they add to the SFR falls as the square of this distance, and has to stay a tenth of what noise
/// scatters.
double trim_of(const FoundEdge& edge, double noise) {
  constexpr double share = 0.06, least_px = 3, most_px = 20;  // at this noise:
  constexpr double usual_noise = 0.01, nearest_px = 2;
  const double farther = std::min(2.0, std::sqrt(usual_noise / std::max(1e-9, noise)));
  return std::clamp(share * farther * edge.length_px(), std::clamp(least_px * farther, nearest_px, least_px),
                    most_px);
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
void choose_part(FoundEdge& edge, double greatest_reach, double noise) {
  constexpr double enough = 10;
  const double half = 0.5 * edge.length_px() - trim_of(edge, noise);
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

/// Sides of all outlines by where they lie, so that what is near a place is found without looking at all.
class SideGrid {
 public:
  explicit SideGrid(const std::vector<TargetOutline>& outlines) {
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
  constexpr double least_reach_px = 4;
  const double noise = noise_share(plane);
  const std::optional<Plane> quieter = quiet(plane, noise);
  const Plane& drawn = quieter ? *quieter : plane;
  std::vector<TargetOutline> outlines;
  for (const LevelContour& contour : level_contours(drawn, halfway_level(drawn), least_points)) {
    std::vector<ContourPoint> corners = straightened(contour, options.tolerance_px);
    if (corners.size() >= 2) outlines.push_back({std::move(corners), contour.closed});
  }
  const SideGrid grid(outlines);
  FoundEdges found;
  for (std::size_t o = 0; o < outlines.size(); ++o)
    for (const Stretch& stretch : stretches_of(outlines[o])) {
      const TargetOutline& outline = outlines[o];
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
      choose_part(edge, options.greatest_reach_px, noise);
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
  // The upright box about the turned one.
  const double across = std::max(edge.reach_dark_px, edge.reach_bright_px),
               along = std::max(-edge.sampled_from, edge.sampled_to);
  const auto range = [](double middle, double reach, int size) {
    return std::pair{std::clamp(static_cast<int>(middle - reach) - 1, 0, size),
                     std::clamp(static_cast<int>(middle + reach) + 2, 0, size)};
  };
  const double ux = std::abs(axis.ux), uy = std::abs(axis.uy);
  const auto [left, right] = range(axis.middle.x, along * ux + across * uy, plane.columns);
  const auto [top, bottom] = range(axis.middle.y, along * uy + across * ux, plane.rows);
  std::vector<EdgeSample> samples;
  const auto first_of = [&](int from, int place) {
    return from + (place - from % lattice.step + lattice.step) % lattice.step;
  };
  for (int row = first_of(top, lattice.row); row < bottom; row += lattice.step)
    for (int column = first_of(left, lattice.column); column < right; column += lattice.step) {
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

}  // namespace petzval
