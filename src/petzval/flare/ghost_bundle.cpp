// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/flare/ghost_bundle.h>
#include <petzval/lens/surface_shape.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval {

namespace {

/// A ray of a bundle: where it enters and where it ends.
struct BundleNode {
  double x_mm = 0, y_mm = 0;  ///< in the plane of the first vertex
  double column = 0, row = 0;
  double weight = 0;  ///< light per area of that plane that arrives
  double clearance = 0;
  bool arrives = false;
  double spread = 0;  ///< pixels per mm² of that plane, signed; 0: not known

  bool passes() const { return arrives && clearance <= 0; }
};

BundleNode follow_node(const GhostTracer& tracer, const GhostPair& pair, const SourceBeam& beam,
                       const SensorGeometry& frame, double x_mm, double y_mm) {
  const GhostLanding end = tracer.follow(beam.ray(x_mm, y_mm), pair);
  BundleNode node{x_mm, y_mm, 0, 0, 0, end.clearance, end.arrives};
  if (!end.arrives) return node;
  const double per_mm = um_per_mm / frame.pitch_um;
  node.column = frame.columns / 2.0 - end.x_mm * per_mm;
  node.row = frame.rows / 2.0 + end.y_mm * per_mm;
  node.weight = end.share * beam.weight(x_mm, y_mm);
  return node;
}

/// The first surface's clear radius; where it has none, well beyond the widest that has.
double front_radius_mm(const Tracer& tracer) {
  const double front = std::sqrt(tracer.clip_radius_sq(0, Tracer::Clip::apertures));
  if (std::isfinite(front)) return front;
  double widest = tracer.stop_radius_mm();
  for (std::size_t i = 0; i < tracer.surface_count(); ++i)
    if (const double radius = std::sqrt(tracer.clip_radius_sq(i, Tracer::Clip::apertures));
        std::isfinite(radius))
      widest = std::max(widest, radius);
  constexpr double beyond = 2;
  return beyond * widest;
}

constexpr int search_cells = 16, search_levels = 4;
/// Rays that pass along each side that make a box tight enough.
constexpr int enough_nodes = 6;

}  // namespace

PupilBox front_box(const Tracer& tracer, const SourceBeam& beam) {
  const double radius = front_radius_mm(tracer);
  const Tracer::PreparedSurface& front = tracer.surfaces()[0];
  const double sag = surface_point(front.shape, 0, radius).sag;
  double depth = std::isfinite(sag) ? std::abs(sag) : radius, x = 0, y = 0;
  if (front.posed) {
    const auto& [offset_x, offset_y, offset_z] = front.frame.offset_mm;
    x = offset_x, y = offset_y;
    depth += std::abs(offset_z) + radius * std::hypot(front.frame.rows[2][0], front.frame.rows[2][1]);
  }
  const auto [slope_x, slope_y] = beam.slope();
  const double wide = radius + depth * std::abs(slope_x), tall = radius + depth * std::abs(slope_y);
  PupilBox box;
  box.left = x - wide, box.right = x + wide, box.low = y - tall, box.high = y + tall;
  return box;
}

void BundleOptions::validate() const {
  if (cells < 4 || cells > 512)
    throw InputError(fmt::format("a bundle of {} cells along a side; 4 to 512 would be right", cells));
  if (edge_divisions < 0 || edge_divisions > 8 || twist_divisions < 0 || twist_divisions > 8)
    throw InputError("cells of a bundle are halved 0 to 8 times");
}

double PupilBox::extent_pixels() const {
  return std::max(columns_to - columns_from, rows_to - rows_from);
}

std::optional<PupilBox> find_pupil_box(const GhostTracer& tracer, const GhostPair& pair,
                                       const SourceBeam& beam, const SensorGeometry& frame) {
  PupilBox box = front_box(tracer.tracer(), beam);
  std::size_t rays = 0;
  constexpr auto side = static_cast<std::size_t>(search_cells + 1);
  std::vector<BundleNode> nodes(side * side);
  for (int level = 0; level <= search_levels; ++level) {
    const double step_x = (box.right - box.left) / search_cells, step_y = (box.high - box.low) / search_cells;
    for (std::size_t j = 0; j < side; ++j)
      for (std::size_t i = 0; i < side; ++i)
        nodes[j * side + i] =
            follow_node(tracer, pair, beam, frame, box.left + static_cast<double>(i) * step_x,
                        box.low + static_cast<double>(j) * step_y);
    rays += nodes.size();
    const BundleNode* best = nullptr;
    PupilBox found;
    found.left = found.low = found.columns_from = found.rows_from = INFINITY;
    found.right = found.high = found.columns_to = found.rows_to = -INFINITY;
    for (const BundleNode& node : nodes) {
      if (node.arrives && (!best || node.clearance < best->clearance)) best = &node;
      if (!node.passes()) continue;
      found.left = std::min(found.left, node.x_mm), found.right = std::max(found.right, node.x_mm);
      found.low = std::min(found.low, node.y_mm), found.high = std::max(found.high, node.y_mm);
      found.columns_from = std::min(found.columns_from, node.column);
      found.columns_to = std::max(found.columns_to, node.column);
      found.rows_from = std::min(found.rows_from, node.row);
      found.rows_to = std::max(found.rows_to, node.row);
    }
    if (!best) return {};
    if (!best->passes()) {
      constexpr double about = 1.5;  // steps
      box.left = best->x_mm - about * step_x, box.right = best->x_mm + about * step_x;
      box.low = best->y_mm - about * step_y, box.high = best->y_mm + about * step_y;
      continue;
    }
    const bool tight = found.right - found.left >= (enough_nodes - 0.5) * step_x &&
                       found.high - found.low >= (enough_nodes - 0.5) * step_y;
    found.left -= step_x, found.right += step_x;
    found.low -= step_y, found.high += step_y;
    found.middle_x = best->x_mm, found.middle_y = best->y_mm;
    box = found;
    if (!tight && level < search_levels) continue;
    for (std::size_t j = 0; j + 1 < side; ++j)
      for (std::size_t i = 0; i + 1 < side; ++i) {
        double most = 0;
        bool any = false;
        for (const std::size_t k :
             {j * side + i, j * side + i + 1, (j + 1) * side + i, (j + 1) * side + i + 1}) {
          any = any || nodes[k].passes();
          most = std::max(most, nodes[k].weight);
        }
        if (any) box.most_mm2 += most * step_x * step_y;
      }
    // What lies between the outermost rays and the edge reaches a little farther.
    const double wide = (box.columns_to - box.columns_from) / enough_nodes + 2,
                 tall = (box.rows_to - box.rows_from) / enough_nodes + 2;
    box.columns_from -= wide, box.columns_to += wide;
    box.rows_from -= tall, box.rows_to += tall;
    box.rays = rays;
    return box;
  }
  return {};
}

namespace {

/// A triangle of a bundle, all of which passes.
struct PassingTriangle {
  std::array<BundleNode, 3> nodes;

  double area_mm2() const {
    return 0.5 * std::abs((nodes[1].x_mm - nodes[0].x_mm) * (nodes[2].y_mm - nodes[0].y_mm) -
                          (nodes[2].x_mm - nodes[0].x_mm) * (nodes[1].y_mm - nodes[0].y_mm));
  }
  double flux_mm2() const { return area_mm2() * (nodes[0].weight + nodes[1].weight + nodes[2].weight) / 3; }
};

BundleNode between(const BundleNode& a, const BundleNode& b, double t) {
  const auto mix = [t](double from, double to) { return from + t * (to - from); };
  return {mix(a.x_mm, b.x_mm),
          mix(a.y_mm, b.y_mm),
          mix(a.column, b.column),
          mix(a.row, b.row),
          mix(a.weight, b.weight),
          mix(a.clearance, b.clearance),
          true,
          mix(a.spread, b.spread)};
}

class BundleMesh {
 public:
  BundleMesh(const GhostTracer& tracer, const GhostPair& pair, const SourceBeam& beam,
             const SensorGeometry& frame, const BundleOptions& options)
      : tracer_(tracer), pair_(pair), beam_(beam), frame_(frame), options_(options) {}

  void cover(const PupilBox& box, int cells) {
    const auto side = static_cast<std::size_t>(cells + 1);
    std::vector<BundleNode> nodes(side * side);
    for (std::size_t j = 0; j < side; ++j)
      for (std::size_t i = 0; i < side; ++i)
        nodes[j * side + i] = follow(box.left + (box.right - box.left) * static_cast<double>(i) / cells,
                                     box.low + (box.high - box.low) * static_cast<double>(j) / cells);
    find_spreads(nodes, side);
    for (std::size_t j = 0; j + 1 < side; ++j)
      for (std::size_t i = 0; i + 1 < side; ++i)
        cell(nodes[j * side + i], nodes[j * side + i + 1], nodes[(j + 1) * side + i],
             nodes[(j + 1) * side + i + 1], 0);
  }

  std::vector<PassingTriangle> triangles;
  std::size_t rays = 0;

 private:
  BundleNode follow(double x_mm, double y_mm) {
    ++rays;
    return follow_node(tracer_, pair_, beam_, frame_, x_mm, y_mm);
  }

  /// At each node the mean over the cells about it, whose corners all arrive.
  static void find_spreads(std::vector<BundleNode>& nodes, std::size_t side) {
    std::vector<int> cells(nodes.size());
    for (std::size_t j = 0; j + 1 < side; ++j)
      for (std::size_t i = 0; i + 1 < side; ++i) {
        const std::array<std::size_t, 4> corner{j * side + i, j * side + i + 1, (j + 1) * side + i,
                                                (j + 1) * side + i + 1};
        const BundleNode &a = nodes[corner[0]], &b = nodes[corner[1]], &c = nodes[corner[2]],
                         &d = nodes[corner[3]];
        if (!a.arrives || !b.arrives || !c.arrives || !d.arrives) continue;
        // Half the product of the diagonals.
        const double area =
            0.5 * ((d.column - a.column) * (c.row - b.row) - (c.column - b.column) * (d.row - a.row));
        const double spread = area / ((d.x_mm - a.x_mm) * (d.y_mm - a.y_mm));
        for (const std::size_t at : corner) nodes[at].spread += spread, ++cells[at];
      }
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (cells[i] > 0) nodes[i].spread /= cells[i];
  }

  void cell(const BundleNode& a, const BundleNode& b, const BundleNode& c, const BundleNode& d, int depth) {
    const int passing = int(a.passes()) + int(b.passes()) + int(c.passes()) + int(d.passes());
    if (passing == 0) return;
    const bool cut = passing < 4;
    const double twist = cut ? 0
                             : std::max(std::abs(a.column - b.column - c.column + d.column),
                                        std::abs(a.row - b.row - c.row + d.row));
    if ((cut && depth < options_.edge_divisions) ||
        (twist > options_.twist_pixels && depth < options_.twist_divisions))
      return divide(a, b, c, d, depth + 1);
    triangle(a, b, d);
    triangle(a, d, c);
  }

  void divide(const BundleNode& a, const BundleNode& b, const BundleNode& c, const BundleNode& d, int depth) {
    const double x = 0.5 * (a.x_mm + d.x_mm), y = 0.5 * (a.y_mm + d.y_mm);
    BundleNode low = follow(x, a.y_mm), left = follow(a.x_mm, y), middle = follow(x, y),
               right = follow(d.x_mm, y), high = follow(x, d.y_mm);
    low.spread = 0.5 * (a.spread + b.spread), left.spread = 0.5 * (a.spread + c.spread);
    right.spread = 0.5 * (b.spread + d.spread), high.spread = 0.5 * (c.spread + d.spread);
    middle.spread = 0.5 * (left.spread + right.spread);
    cell(a, low, left, middle, depth);
    cell(low, b, middle, right, depth);
    cell(left, middle, c, high, depth);
    cell(middle, right, high, d, depth);
  }

  /// The part of a triangle that clears the apertures, its clearance taken as linear.
  void triangle(const BundleNode& a, const BundleNode& b, const BundleNode& c) {
    const std::array<const BundleNode*, 3> corner{&a, &b, &c};
    std::array<BundleNode, 4> kept;
    std::size_t count = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const BundleNode &here = *corner[i], &next = *corner[(i + 1) % 3];
      if (here.passes()) kept[count++] = here;
      if (here.passes() == next.passes()) continue;
      const BundleNode &in = here.passes() ? here : next, &out = here.passes() ? next : here;
      // A ray that ends on its way says nothing of where the edge is: midway.
      kept[count++] = out.arrives ? between(in, out, in.clearance / (in.clearance - out.clearance)) : in;
    }
    for (std::size_t i = 1; i + 1 < count; ++i) triangles.push_back({{kept[0], kept[i], kept[i + 1]}});
  }

  const GhostTracer& tracer_;
  const GhostPair& pair_;
  const SourceBeam& beam_;
  const SensorGeometry& frame_;
  const BundleOptions& options_;
};

/// Light that varies smoothly over a triangle, and how much of it there would be on its area.
struct Shading {
  std::array<double, 3> light{};
  double flux = 0;
};

/// Nothing where the lens folds the bundle, or nearly, or the triangle is so small that nobody sees its
/// shade.
std::optional<Shading> shading_of(const PassingTriangle& triangle) {
  constexpr double least_ratio = 0.3, least_pixels = 4;
  const auto& [a, b, c] = triangle.nodes;
  const double area =
      0.5 * std::abs((b.column - a.column) * (c.row - a.row) - (c.column - a.column) * (b.row - a.row));
  const auto [low, high] = std::minmax({a.spread, b.spread, c.spread});
  if (area < least_pixels || low * high <= 0) return {};
  if (std::min(std::abs(low), std::abs(high)) < least_ratio * std::max(std::abs(low), std::abs(high)))
    return {};
  Shading shading;
  for (std::size_t i = 0; i < 3; ++i)
    shading.light[i] = triangle.nodes[i].weight / std::abs(triangle.nodes[i].spread);
  shading.flux = area * (shading.light[0] + shading.light[1] + shading.light[2]) / 3;
  return shading.flux > 0 ? std::optional(shading) : std::nullopt;
}

/// Triangles of a bundle with a share of its light. Those that can be shaded have the light of their corners,
/// so that neighbours meet; all of them together keep the light that entered between their rays.
void add_facets(const std::vector<PassingTriangle>& triangles, double share, GhostBundle& bundle) {
  double entered = 0, shaded = 0;
  std::vector<std::optional<Shading>> shadings;
  for (const PassingTriangle& each : triangles) {
    shadings.push_back(shading_of(each));
    if (shadings.back()) entered += each.flux_mm2(), shaded += shadings.back()->flux;
  }
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    const auto& nodes = triangles[k].nodes;
    LightFacet facet{{nodes[0].column, nodes[1].column, nodes[2].column},
                     {nodes[0].row, nodes[1].row, nodes[2].row},
                     share * triangles[k].flux_mm2()};
    if (shadings[k]) {
      const std::array<double, 3>& light = shadings[k]->light;
      facet.flux = share * shadings[k]->flux * entered / shaded;
      for (std::size_t i = 0; i < 3; ++i) facet.shade[i] = 3 * light[i] / (light[0] + light[1] + light[2]);
    }
    bundle.flux_mm2 += facet.flux;
    bundle.facets.push_back(facet);
  }
}

/// How far the whole source moves the end of one ray [pixels].
double source_pixels(const GhostTracer& tracer, const GhostPair& pair, const BrightSource& source,
                     const PupilBox& box, const SensorGeometry& frame) {
  if (source.radius_rad == 0) return 0;
  const auto end = [&](double side, double up) {
    return follow_node(tracer, pair, SourceBeam(source, {side, up}), frame, box.middle_x, box.middle_y);
  };
  const BundleNode middle = end(0, 0);
  double farthest = 0;
  for (const auto& [side, up] :
       {std::array{1.0, 0.0}, std::array{0.0, 1.0}, std::array{-1.0, 0.0}, std::array{0.0, -1.0}})
    if (const BundleNode node = end(side, up); node.arrives && middle.arrives)
      farthest = std::max(farthest, std::hypot(node.column - middle.column, node.row - middle.row));
  return 2 * farthest;
}

}  // namespace

GhostBundle trace_bundle(const GhostTracer& tracer, const GhostPair& pair, const BrightSource& source,
                         const PupilBox& box, const SensorGeometry& frame, const BundleOptions& options) {
  GhostBundle bundle;
  const double spread = source_pixels(tracer, pair, source, box, frame), extent = box.extent_pixels();
  constexpr double small_pixels = 2;
  if (spread <= std::max(extent, small_pixels)) {
    // As many points as leave no steps between their bundles.
    constexpr double points_across = 5, most_points = 37;
    const double step = std::max(small_pixels, extent / points_across);
    const int points =
        spread < small_pixels
            ? 1
            : static_cast<int>(std::clamp(std::ceil(std::pow(spread / step, 2)), 1.0, most_points));
    // Many bundles smooth each other's edges.
    const int cells = std::max(8, static_cast<int>(options.cells / std::cbrt(points)));
    BundleOptions each = options;
    if (points > 1) each.edge_divisions = std::min(options.edge_divisions, 1);
    for (const std::array<double, 2>& place : even_disc(points)) {
      const SourceBeam beam(source, place);
      BundleMesh mesh(tracer, pair, beam, frame, each);
      mesh.cover(box, cells);
      bundle.rays += mesh.rays;
      add_facets(mesh.triangles, 1.0 / points, bundle);
    }
    return bundle;
  }
  // Wider than the ghost of a point: triangles of the disc through each part of the pupil.
  constexpr int pupil_cells = 6, rings = 4;
  BundleOptions coarse = options;
  coarse.edge_divisions = std::min(options.edge_divisions, 1);
  coarse.twist_divisions = 0;
  const SourceBeam middle(source);
  BundleMesh mesh(tracer, pair, middle, frame, coarse);
  mesh.cover(box, pupil_cells);
  bundle.rays = mesh.rays;
  const DiscMesh disc = DiscMesh::of_rings(rings);
  std::vector<SourceBeam> beams;
  for (const std::array<double, 2>& place : disc.nodes) beams.emplace_back(source, place);
  for (const PassingTriangle& each : mesh.triangles) {
    double x = 0, y = 0;
    for (const BundleNode& node : each.nodes) x += node.x_mm / 3, y += node.y_mm / 3;
    std::vector<BundleNode> ends;
    for (const SourceBeam& beam : beams) ends.push_back(follow_node(tracer, pair, beam, frame, x, y));
    bundle.rays += ends.size();
    for (std::size_t i = 0; i < disc.triangles.size(); ++i) {
      const auto& [a, b, c] = disc.triangles[i];
      const BundleNode &p = ends[a], &q = ends[b], &r = ends[c];
      if (!p.arrives || !q.arrives || !r.arrives) continue;
      const double flux = each.area_mm2() * disc.shares[i] * (p.weight + q.weight + r.weight) / 3;
      bundle.flux_mm2 += flux;
      bundle.facets.push_back({{p.column, q.column, r.column}, {p.row, q.row, r.row}, flux});
    }
  }
  return bundle;
}

}  // namespace petzval
