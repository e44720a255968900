// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/imaging/product_layout.h>
#include <petzval/imaging/product_plan.h>
#include <petzval/imaging/tile_blur.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace petzval {

namespace {

constexpr int most_nodes = 6;
/// What the mean over places may miss of the whole grid's: the estimate must stay below the tolerance by this
/// factor. A band may come somewhat closer before the plan of its neighbour is given up.
constexpr double caution = 0.4, caution_of_hint = 0.5;
/// Kernels of a band should not take more memory than this: then the transfer functions of some rows of tiles
/// are held at a time. Those of one row must not take more than that.
constexpr double most_kernel_bytes = 400e6, most_row_bytes = 1600e6;

/// Measured on one core of an AVX-512 machine with bench/imaging [ns].
constexpr double kernel_fixed_ns = 1700;  // of a kernel, whatever its size
constexpr double deposit_ns = 2.5;        // per sample of a PSF and cell of a kernel

bool is_whole(const CellRing& zone) {
  return zone.from == 0 && std::isinf(zone.to);
}

/// Of the tiles of a layout, those in the grid's zone, about.
double tile_share(const SourceGrid& grid, int tile) {
  if (is_whole(grid.zone)) return 1;
  constexpr int most = 64;  // along an axis
  const OutwardAxis across(grid.cells.columns), down(grid.cells.rows);
  return TilesInZone(grid.zone, across, down, std::max(tile, std::max(across.count(), down.count()) / most))
      .share();
}

/// Kernels that a layout needs, and what one costs without its transform.
double kernel_count(const PsfField& psfs, const SourceGrid& grid, const ProductPlan& plan) {
  const double across = std::ceil(OutwardAxis(grid.cells.columns).count() / double(plan.tile)),
               down = std::ceil(OutwardAxis(grid.cells.rows).count() / double(plan.tile));
  const auto sets = double(kernel_set_count(psfs.symmetry()));
  return sets * ((plan.nodes - 1) * across + 1) * ((plan.nodes - 1) * down + 1) * tile_share(grid, plan.tile);
}
double kernel_ns(const PsfField& psfs) {
  const double size = 2.0 * psfs.radius() + 1;
  return kernel_fixed_ns + deposit_ns * (psfs.coefficients() + size * size);
}

/// Says what the transfer functions of a plan take, and how many rows of tiles are held at a time for that.
/// \return  bytes of all of them.
double hold_otfs(const PsfField& psfs, const SourceGrid& grid, ProductPlan& plan) {
  const double side = plan.transform, bytes = (side * side + 2 * side) * sizeof(float);
  const double all = plan.kernel_bytes = kernel_count(psfs, grid, plan) * bytes;
  if (all <= most_kernel_bytes) return all;
  const int phases = plan.nodes - 1;
  const double row =
      bytes * (phases * std::ceil(OutwardAxis(grid.cells.columns).count() / double(plan.tile)) + 1);
  plan.rows_held = std::max(1, static_cast<int>((most_kernel_bytes / row - 1) / phases));
  plan.kernel_bytes = row * (phases * plan.rows_held + 1);
  return all;
}

/// Gathered sums that might do, and what they would cost.
ProductPlan direct_candidate(const PsfField& psfs, const SourceGrid& grid, int tile, int nodes) {
  const double product_ns = 0.58 / double(lane_count());  // per product
  constexpr double mix_ns = 0.1;                          // per weight of a kernel that goes into a mixture
  constexpr double add_ns = 5;                            // per cell whose light is prepared and added
  ProductPlan plan;
  plan.tile = tile;
  plan.nodes = nodes;
  plan.direct = true;
  const double taps = 2.0 * psfs.radius() + 1, extent = tile + 2.0 * psfs.radius();
  const double across = std::ceil(OutwardAxis(grid.cells.columns).count() / double(tile));
  const double per_row_and_tile =
      extent * (nodes * taps * taps * product_ns + add_ns) + double(nodes) * nodes * taps * taps * mix_ns;
  plan.filter_ns = 2 * across * grid.cells.rows * per_row_and_tile;
  plan.kernels_ns = kernel_count(psfs, grid, plan) * kernel_ns(psfs);
  plan.kernel_bytes = kernel_count(psfs, grid, plan) * taps * taps * sizeof(float);
  return plan;
}

/// A layout that might do, and what it would cost.
ProductPlan candidate(const PsfField& psfs, const SourceGrid& grid, int transform, int tile, int nodes) {
  constexpr double line_ns = 8;           // of a vector, per element of a line: transformed, turned, filtered
  constexpr double fetch_ns = 0.04;       // per byte of transfer functions
  constexpr double kernel_line_ns = 1.1;  // of a vector, per element and halving of a kernel's line
  ProductPlan plan;
  plan.tile = tile;
  plan.nodes = nodes;
  plan.transform = transform;
  plan.zone = grid.zone;
  const double across = std::ceil(OutwardAxis(grid.cells.columns).count() / double(tile)),
               down = std::ceil(OutwardAxis(grid.cells.rows).count() / double(tile));
  const double lanes = double(lane_count()), columns = transform / lanes;
  const double lines = nodes * std::ceil(tile / lanes) + (nodes * nodes + 1) * columns +
                       std::ceil((tile + 2 * psfs.radius()) / lanes);
  const double bytes = hold_otfs(psfs, grid, plan);
  // Two quadrants at a time, where they share kernels.
  const int pairs = psfs.symmetry() == KernelSymmetry::none ? 4 : 2;
  plan.filter_ns =
      pairs * across * down * tile_share(grid, tile) * lines * transform * line_ns + bytes * fetch_ns;
  const double kernel_lines = (std::ceil((2 * psfs.radius() + 1) / lanes) + columns) / 2;
  plan.kernels_ns = kernel_count(psfs, grid, plan) *
                    (kernel_ns(psfs) + kernel_lines * transform * std::log2(transform) * kernel_line_ns);
  return plan;
}

/// Calls use(tile, nodes) for the layouts whose tiles fit into some room.
template <typename Use>
void each_layout(int room, const ProductOptions& options, const Use& use) {
  std::vector<int> tiles;
  if (options.tile != 0)
    tiles = {options.tile};
  else
    for (int tile = room; tile >= 2; tile = tile * 2 / 3) tiles.push_back(tile);
  for (const int tile : tiles)
    for (int nodes = 2; nodes <= most_nodes; ++nodes)
      if (tile <= room && nodes <= tile + 1 && (options.nodes == 0 || nodes == options.nodes))
        use(tile, nodes);
}

/// Layouts that hold all kernels, or those that hold some rows at a time, the cheapest first.
std::vector<ProductPlan> candidates(const PsfField& psfs, const SourceGrid& grid,
                                    const ProductOptions& options, bool by_rows) {
  constexpr int most_direct_radius = 16;  // far beyond where transforms have won
  std::vector<ProductPlan> plans;
  const int widest = std::max(OutwardAxis(grid.cells.columns).count(), OutwardAxis(grid.cells.rows).count());
  if (is_whole(grid.zone) && options.direct.value_or(true) && psfs.radius() <= most_direct_radius)
    each_layout(std::min(TileTransform::largest, widest), options,
                [&](int tile, int nodes) { plans.push_back(direct_candidate(psfs, grid, tile, nodes)); });
  for (const int transform : TileTransform::sizes)
    if (!options.direct.value_or(false))
      each_layout(std::min(transform - 2 * psfs.radius(), widest), options, [&](int tile, int nodes) {
        plans.push_back(candidate(psfs, grid, transform, tile, nodes));
      });
  std::erase_if(plans, [&](const ProductPlan& plan) {
    return (plan.rows_held != 0) != by_rows ||
           plan.kernel_bytes > (by_rows ? most_row_bytes : most_kernel_bytes);
  });
  std::sort(plans.begin(), plans.end(), [](const ProductPlan& a, const ProductPlan& b) {
    return a.filter_ns + a.kernels_ns < b.filter_ns + b.kernels_ns;
  });
  return plans;
}

/// Cells of the grid in a ring, those beyond the picture too.
double cells_in(const CellRing& ring, const SensorGeometry& grid) {
  const double half_width = grid.columns / 2.0;
  // Of half a row, from the middle to a radius.
  const auto within = [&](double radius, double below) {
    const double squared = radius * radius - below * below;
    return squared > 0 ? std::min(half_width, std::sqrt(squared)) : 0.0;
  };
  double cells = 0;
  for (int row = 0; row < grid.rows; ++row) {
    const double below = row + 0.5 - grid.rows / 2.0;
    cells += 2 * (within(ring.to, below) - within(ring.from, below));
  }
  return cells;
}

/// Gives the plan what cells at the rim need kernels of their own, and the error that it has then. Whether
/// that keeps it within the limit.
bool mend_rim(const PsfField& psfs, const SourceGrid& grid, const RimError& rim, ProductPlan& plan) {
  constexpr double weight_ns = 10;  // of exact_blur, per weight of a kernel and sample of its PSF
  const double sharing = psfs.symmetry() == KernelSymmetry::mirrored ? 4 : 1;
  const double size = 2.0 * psfs.radius() + 1;
  plan.rim_error = rim;
  plan.exact = rim.ring;
  plan.exact_ns = rim.ring.empty() ? 0
                                   : cells_in(rim.ring, grid.cells) / sharing * weight_ns *
                                         (psfs.coefficients() + size * size);
  plan.estimated_error = std::hypot(plan.estimated_error, std::sqrt(rim.mean_square));
  return rim.within;
}

/// The plan of a neighbouring band or layer, if it serves.
std::optional<ProductPlan> kept_plan(const ProductPlan& hint, const PsfField& psfs, const SourceGrid& grid,
                                     const ProductOptions& options, LayoutErrors& errors) {
  const int needed = hint.tile + 2 * psfs.radius();
  const auto smallest = std::ranges::find_if(TileTransform::sizes, [&](int size) { return size >= needed; });
  const int transform = hint.transform != 0                      ? hint.transform
                        : smallest != TileTransform::sizes.end() ? *smallest
                                                                 : 0;
  if (!hint.direct && needed > transform) return {};
  ProductPlan plan = hint.direct ? direct_candidate(psfs, grid, hint.tile, hint.nodes)
                                 : candidate(psfs, grid, transform, hint.tile, hint.nodes);
  // To look at a place takes as many kernels as there are nodes around it, and one; that should not cost more
  // than half of what the picture needs.
  const double worth = kernel_count(psfs, grid, plan) / (2 * (2.0 * plan.nodes + 1));
  const int places = static_cast<int>(std::clamp(worth, 2.0, double(KernelError::first_places)));
  plan.error_at_places = errors.at_places_like(hint.error_at_places, plan.tile, plan.nodes, places);
  plan.estimated_error = plan.error_at_places.rms;
  if (options.layout_given()) return plan;
  const double limit = caution_of_hint * options.tolerance;
  if (plan.estimated_error > limit) return {};
  if (!std::isinf(grid.zone.to)) return plan;
  const RimError rim = errors.at_rim_like(hint.rim_error, plan.tile, plan.nodes, limit);
  // A rim that has grown may want kernels of its own for far more cells: then another layout is cheaper.
  constexpr double much_dearer = 1.5;
  if (!mend_rim(psfs, grid, rim, plan) || plan.total_ns() > much_dearer * hint.total_ns()) return {};
  return plan;
}

}  // namespace

void ProductOptions::validate() const {
  if (!(tolerance >= 1e-6 && tolerance <= 1))
    throw InputError(fmt::format("a tolerance of {}: 1e-6 to 1 is right", tolerance));
  if (nodes != 0 && (nodes < 2 || nodes > most_nodes))
    throw InputError(
        fmt::format("{} nodes along a tile: 2 to {} are right, or 0 to choose", nodes, most_nodes));
  if (tile < 0 || tile == 1 || tile > TileTransform::largest)
    throw InputError(
        fmt::format("tiles of {} cells: 2 to {} are right, or 0 to choose", tile, TileTransform::largest));
}

namespace {

/// Whether a layout fails where another has failed: a coarser one does, and one that is finer by too little.
/// With n nodes the square of an error falls by the power 2n of a tile's side, and slower where kernels are
/// rough.
bool fails_like(const ProductPlan& failed, const ProductPlan& plan, double limit) {
  if (plan.nodes > failed.nodes) return false;
  if (plan.tile >= failed.tile) return true;
  constexpr double luck = 4;
  const double beyond = std::pow(failed.error_at_places.rms / limit, 2);
  return beyond * std::pow(double(plan.tile) / failed.tile, 2 * failed.nodes) > luck;
}

void take_errors(const ProductPlan& from, ProductPlan& plan) {
  plan.error_at_places = from.error_at_places;
  plan.rim_error = from.rim_error;
  plan.estimated_error = from.estimated_error;
  plan.exact = from.exact;
  plan.exact_ns = from.exact_ns;
}

/// Layouts of a zone whose errors are known.
struct KnownLayouts {
  LayoutErrors errors;
  std::vector<ProductPlan> failed = {}, served = {};

  KnownLayouts(const PsfField& psfs, const SourceGrid& grid) : errors(psfs, grid) {}
};

/// The cheapest layout for a zone, if any serves. Those that take longer than `most_ns` are not looked at.
std::optional<ProductPlan> cheapest(const PsfField& psfs, const SourceGrid& grid,
                                    const ProductOptions& options, KnownLayouts& known,
                                    double most_ns = INFINITY) {
  LayoutErrors& errors = known.errors;
  std::vector<ProductPlan>&failed = known.failed, &served = known.served;
  const double limit = options.layout_given() ? INFINITY : caution * options.tolerance;
  const auto serves = [&](ProductPlan& plan) {
    plan.error_at_places = errors.at_places(plan.tile, plan.nodes, limit);
    plan.estimated_error = plan.error_at_places.rms;
    if (options.layout_given()) return true;
    if (plan.estimated_error > limit) return false;
    return !std::isinf(grid.zone.to) ||
           mend_rim(psfs, grid, errors.at_rim(plan.tile, plan.nodes, limit), plan);
  };
  std::optional<ProductPlan> best;
  // Layouts come the cheapest first: what needs as many kernels of cells as another before it is dearer.
  const auto too_dear = [&](const ProductPlan& plan) {
    return best && !best->exact.empty() &&
           !errors.does_with_less(plan.tile, plan.nodes, limit, best->rim_error.ring);
  };
  const auto choose = [&](bool by_rows) {
    for (ProductPlan& plan : candidates(psfs, grid, options, by_rows)) {
      if (plan.total_ns() >= std::min(most_ns, best ? best->total_ns() : INFINITY)) break;
      if (std::ranges::any_of(failed,
                              [&](const ProductPlan& other) { return fails_like(other, plan, limit); }))
        continue;
      // Another size of transforms makes the same errors.
      const auto same = std::ranges::find_if(served, [&](const ProductPlan& other) {
        return plan.tile == other.tile && plan.nodes == other.nodes;
      });
      if (same != served.end())
        take_errors(*same, plan);
      else if (!too_dear(plan) && serves(plan))
        served.push_back(plan);
      else {
        failed.push_back(plan);
        continue;
      }
      if (!best || plan.total_ns() < best->total_ns()) best = plan;
    }
  };
  choose(false);
  // Many kernels of cells at the rim cost more than those of more nodes do.
  if (!best || best->exact_ns > best->filter_ns + best->kernels_ns) choose(true);
  return best;
}

/// The grid within a radius, and without it. Where light passes from one to the other both count.
SourceGrid inner_zone(SourceGrid grid, double radius) {
  grid.zone.to = radius;
  return grid;
}
SourceGrid outer_zone(SourceGrid grid, double radius) {
  grid.zone.from = radius - ProductPlan::fade;
  return grid;
}

/// Two zones share the square of the error.
ProductOptions of_zone(ProductOptions options) {
  options.tolerance *= std::sqrt(0.5);
  return options;
}

ProductPlan with_inner(ProductPlan outer, const ProductPlan& inner) {
  outer.estimated_error = std::hypot(outer.estimated_error, inner.estimated_error);
  outer.kernel_bytes += inner.kernel_bytes;
  outer.inner = {inner};
  return outer;
}

/// Large tiles about the axis and small ones at the rim, if that is cheaper than another plan.
void try_zones(const PsfField& psfs, const SourceGrid& grid, const ProductOptions& options,
               std::optional<ProductPlan>& best) {
  constexpr std::array parts_of_rim{0.85, 0.94};
  const SensorGeometry& cells = grid.cells;
  const double corner = std::hypot(cells.columns / 2.0 - grid.margin, cells.rows / 2.0 - grid.margin),
               rim = std::min(corner, psfs.rim_mm() / (psfs.cell_um() * mm_per_um));
  for (const double part : parts_of_rim) {
    const double radius = part * rim;
    if (radius <= ProductPlan::fade) continue;
    const SourceGrid inside = inner_zone(grid, radius), outside = outer_zone(grid, radius);
    KnownLayouts known_inside(psfs, inside), known_outside(psfs, outside);
    const double most_ns = best ? best->total_ns() : INFINITY;
    const auto inner = cheapest(psfs, inside, of_zone(options), known_inside, most_ns);
    if (!inner || inner->total_ns() >= most_ns) continue;
    const double left_ns = most_ns - inner->total_ns();
    const auto outer = cheapest(psfs, outside, of_zone(options), known_outside, left_ns);
    if (!outer || outer->total_ns() >= left_ns) continue;
    best = with_inner(*outer, *inner);
  }
}

/// A plan of zones for a neighbouring band or layer, if both zones' serve.
std::optional<ProductPlan> kept_zones(const ProductPlan& hint, const PsfField& psfs, const SourceGrid& grid,
                                      const ProductOptions& options) {
  const double radius = hint.inner.front().zone.to;
  const SourceGrid inside = inner_zone(grid, radius), outside = outer_zone(grid, radius);
  LayoutErrors errors_inside(psfs, inside), errors_outside(psfs, outside);
  const auto inner = kept_plan(hint.inner.front(), psfs, inside, of_zone(options), errors_inside);
  if (!inner) return {};
  const auto outer = kept_plan(hint, psfs, outside, of_zone(options), errors_outside);
  if (!outer) return {};
  return with_inner(*outer, *inner);
}

}  // namespace

std::optional<ProductPlan> plan_product(const PsfField& psfs, const SourceGrid& grid,
                                        const ProductOptions& options,
                                        const std::optional<ProductPlan>& hint) {
  options.validate();
  KnownLayouts known(psfs, grid);
  if (hint)
    if (std::optional<ProductPlan> plan = hint->inner.empty()
                                              ? kept_plan(*hint, psfs, grid, options, known.errors)
                                              : kept_zones(*hint, psfs, grid, options))
      return plan;
  // To look at zones takes as long as that.
  constexpr double worth_zones_ns = 0.5e9;
  if (options.tile != 0 || options.nodes != 0 || options.direct) return cheapest(psfs, grid, options, known);
  std::optional<ProductPlan> best = cheapest(psfs, grid, options, known, worth_zones_ns);
  if (best && best->total_ns() <= worth_zones_ns) return best;
  try_zones(psfs, grid, options, best);
  const double most_ns = best ? best->total_ns() : INFINITY;
  std::optional<ProductPlan> one_zone = cheapest(psfs, grid, options, known, most_ns);
  return one_zone && one_zone->total_ns() < most_ns ? one_zone : best;
}

ProductPlan plan_blended(const PsfField& psfs, const SourceGrid& grid, const ProductOptions& options) {
  options.validate();
  ProductPlan plan;
  plan.tile = std::max(TileTransform::largest, psfs.radius());
  LayoutErrors errors(psfs, grid);
  while (true) {
    const double limit = caution * options.tolerance;
    plan.estimated_error = errors.at_places(plan.tile, plan.nodes, plan.tile == 1 ? INFINITY : limit).rms;
    if (plan.estimated_error <= limit || plan.tile == 1) return plan;
    plan.tile /= 2;
  }
}

}  // namespace petzval
