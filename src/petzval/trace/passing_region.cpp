// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/trace/passing_region.h>
#include <petzval/trace/pupil.h>
#include <petzval/trace/radiance_tracer.h>

#include <cmath>

namespace petzval {

namespace {

/// Half of a grid (u > 0): points in the middle of cells.
struct Grid {
  int columns, rows;
};
constexpr Grid first_look{64, 128}, closer_look{32, 64}, last_look{96, 192};
/// A box of rays that pass is worth another look when it is smaller than this share of what was scanned.
constexpr double worth_zooming = 0.6;
constexpr int most_looks = 12;
/// How much a box grows on a side where rays pass at its edge.
constexpr double widening = 0.2;
/// For pupils that fall between the points of the first grid.
constexpr int aimed_azimuths = 16;

class Scan {
 public:
  Scan(const Pencil& pencil, const RadianceTracer& tracer, Grid grid, const LabelBox& box)
      : grid_(grid),
        box_(box),
        cell_u_(box.high_u / grid.columns),
        cell_v_((box.high_v - box.low_v) / grid.rows) {
    const auto count = static_cast<std::size_t>(grid.columns * grid.rows);
    RadianceRays rays(count);
    std::size_t i = 0;
    for (int r = 0; r < grid.rows; ++r)
      for (int c = 0; c < grid.columns; ++c, ++i) {
        // A label that has no ray keeps a direction of zeros, which fails.
        const std::optional<Ray> ray = pencil.ray(u(c), v(r));
        if (!ray) continue;
        rays.x_mm[i] = static_cast<float>(ray->point_mm[0]);
        rays.y_mm[i] = static_cast<float>(ray->point_mm[1]);
        rays.z_mm[i] = static_cast<float>(ray->point_mm[2]);
        rays.l[i] = static_cast<float>(ray->direction[0]);
        rays.m[i] = static_cast<float>(ray->direction[1]);
        rays.n[i] = static_cast<float>(ray->direction[2]);
      }
    tracer.trace(rays);
    passes_ = std::move(rays.passes);
  }

  /// The box of what passes, a cell wider; nothing if nothing does.
  std::optional<LabelBox> bounds() const {
    int last_column = -1, first_row = grid_.rows, last_row = -1;
    for (int r = 0; r < grid_.rows; ++r)
      for (int c = 0; c < grid_.columns; ++c)
        if (at(c, r)) {
          last_column = std::max(last_column, c);
          first_row = std::min(first_row, r);
          last_row = r;
        }
    if (last_row < 0) return {};
    return LabelBox{u(last_column) + cell_u_, v(first_row) - cell_v_, v(last_row) + cell_v_};
  }

  /// The box wider on the sides where rays pass at its very edge; nothing if there are none.
  std::optional<LabelBox> widened() const {
    bool right = false, below = false, above = false;
    for (int r = 0; r < grid_.rows; ++r) right |= at(grid_.columns - 1, r);
    for (int c = 0; c < grid_.columns; ++c) {
      below |= at(c, 0);
      above |= at(c, grid_.rows - 1);
    }
    if (!right && !below && !above) return {};
    const double by = widening * (box_.high_v - box_.low_v);
    return LabelBox{box_.high_u * (right ? 1 + widening : 1), box_.low_v - (below ? by : 0),
                    box_.high_v + (above ? by : 0)};
  }

  PassingRegion region(const LabelBox& bounds) const {
    PassingRegion region{bounds, cell_u_, cell_v_, {}, 0, grid_.columns, grid_.rows, passes_};
    for (int r = 0; r < grid_.rows; ++r)
      for (int c = 0; c < grid_.columns; ++c) {
        if (!at(c, r)) continue;
        region.area += 2 * cell_u_ * cell_v_;
        if (!at(c - 1, r) || !at(c + 1, r) || !at(c, r - 1) || !at(c, r + 1))
          region.outline.emplace_back(u(c), v(r));
      }
    return region;
  }

 private:
  double u(int column) const { return (column + 0.5) * cell_u_; }
  double v(int row) const { return box_.low_v + (row + 0.5) * cell_v_; }
  /// Beyond the axis lies the mirror image, beyond the box nothing.
  bool at(int column, int row) const {
    if (column < 0) column = -1 - column;
    if (column >= grid_.columns || row < 0 || row >= grid_.rows) return false;
    return passes_[static_cast<std::size_t>(row * grid_.columns + column)] != 0;
  }

  Grid grid_;
  LabelBox box_;
  double cell_u_, cell_v_;
  std::vector<std::uint8_t> passes_;
};

/// Every label that can pass: a beam through the front rim lies within √2 of its radius around vertex 1, as
/// no sphere's sag exceeds its rim.
LabelBox box_of_all(const Tracer& tracer, const Pencil& pencil, Tracer::Clip clip) {
  LabelRange range = label_range(tracer, pencil);
  const double front_sq = tracer.clip_radius_sq(0, clip);
  if (pencil.object_at_infinity() && std::isfinite(front_sq)) {
    const double reach = 1.5 * std::sqrt(front_sq);
    range = {-reach, reach};
  }
  return {range.high, range.low, range.high};
}

/// Around the boundary that aiming finds.
std::optional<LabelBox> aimed_box(const Tracer& tracer, const Pencil& pencil, Tracer::Clip clip) {
  const std::optional<double> chief = aim_chief_ray(tracer, pencil, 0);
  if (!chief) return {};
  const std::optional<PupilBoundary> pupil = find_pupil(tracer, pencil, *chief, aimed_azimuths, clip);
  if (!pupil) return {};
  const double widest = *std::max_element(pupil->radius.begin(), pupil->radius.end());
  return LabelBox{2 * widest, pupil->centre_v - 2 * widest, pupil->centre_v + 2 * widest};
}

}  // namespace

std::optional<PassingRegion> find_passing_region(const Tracer& tracer, const Pencil& pencil,
                                                 Tracer::Clip clip) {
  const RadianceTracer radiance(
      tracer, pencil.backward() ? RadianceTracer::Direction::backward : RadianceTracer::Direction::forward,
      clip);
  LabelBox box = box_of_all(tracer, pencil, clip);
  std::optional<LabelBox> bounds = Scan(pencil, radiance, first_look, box).bounds();
  if (!bounds) bounds = aimed_box(tracer, pencil, clip);
  for (int look = 0; bounds && look < most_looks; ++look) {
    const bool zoomed = bounds->high_u > worth_zooming * box.high_u &&
                        bounds->high_v - bounds->low_v > worth_zooming * (box.high_v - box.low_v);
    box = *bounds;
    if (zoomed) break;
    bounds = Scan(pencil, radiance, closer_look, box).bounds();
  }
  if (!bounds) return {};
  // The tips of a sliver are thinner than the cells of the first looks.
  for (int look = 0;; ++look) {
    const Scan scan(pencil, radiance, last_look, box);
    const std::optional<LabelBox> wider = scan.widened();
    if (wider && look < most_looks) {
      box = *wider;
      continue;
    }
    const std::optional<LabelBox> last = scan.bounds();
    if (!last) return {};
    return scan.region(*last);
  }
}

}  // namespace petzval
