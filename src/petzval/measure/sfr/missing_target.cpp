// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/measure/sfr/missing_target.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// Distance of a place from a straight piece of an outline.
double distance_from(const OutlineSide& side, const ContourPoint& p) {
  const double ex = side.to.x - side.from.x, ey = side.to.y - side.from.y;
  const double px = p.x - side.from.x, py = p.y - side.from.y;
  const double t = std::clamp((px * ex + py * ey) / std::max(1e-300, ex * ex + ey * ey), 0.0, 1.0);
  return std::hypot(px - t * ex, py - t * ey);
}

}  // namespace

MissingTarget::MissingTarget(const FoundEdge& edge, bool sampled) {
  // ∬ r⁻³ dA = −∮ (x·n)/r³ ds, n outward: the outlines of what is bright, the other way round …
  FluxSides far;
  const auto add = [](FluxSides& sides, const ContourPoint& from, const ContourPoint& to) {
    sides.add(from.x, from.y, to.x - from.x, to.y - from.y);
  };
  EdgeLine line = edge.line();
  const double nx = std::cos(line.normal_rad), ny = std::sin(line.normal_rad), ex = ny, ey = -nx;
  const double along = 0.5 * (edge.sampled_from + edge.sampled_to);
  const double across = 0.5 * (edge.reach_bright_px - edge.reach_dark_px);
  line.centre_x += along * ex, line.centre_y += along * ey;
  line.half_length = std::max(1.0, 0.5 * (edge.sampled_to - edge.sampled_from));
  const ContourPoint middle{line.centre_x + across * nx, line.centre_y + across * ny};
  const double radius = std::hypot(line.half_length, 0.5 * (edge.reach_bright_px + edge.reach_dark_px));
  for (const OutlineSide& side : edge.neighbours)
    add(!sampled || distance_from(side, middle) < 1.5 * radius ? near_ : far, side.to, side.from);
  // … minus the line of the half-plane beyond the ends of the edge.
  constexpr double beyond = 1e6;
  if (edge.corner_at_from) add(near_, {edge.from.x - beyond * ex, edge.from.y - beyond * ey}, edge.from);
  if (edge.corner_at_to) add(near_, edge.to, {edge.to.x + beyond * ex, edge.to.y + beyond * ey});
  if (far.empty()) return;
  // At 1.5 times the radius seven nodes are good to 2.6⁻⁷ = 1e-3 of what those sides add, which is 1e-3 of
  // the step.
  far_.emplace([&](double x, double y) { return far.flux(x, y); }, line,
               DistanceRange{-edge.reach_dark_px, edge.reach_bright_px}, SmoothAboutEdge::Nodes{7, 7});
}

double MissingTarget::operator()(double x, double y) const {
  return near_.flux(x, y) + (far_ ? (*far_)(x, y) : 0);
}

}  // namespace petzval
