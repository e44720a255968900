// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/base/units.h>
#include <petzval/imaging/kernel_error.h>
#include <petzval/imaging/node_kernel.h>
#include <petzval/imaging/product_layout.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>
#include <vector>

namespace petzval {

namespace {

/// Digit reversal: spreads `index` = 1, 2, … evenly over (0, 1).
double radical_inverse(int index, int base) {
  double value = 0, digit = 1.0 / base;
  for (; index > 0; index /= base, digit /= base) value += digit * (index % base);
  return value;
}

/// The cells of a kernel whose light lands in the picture, from its middle.
struct LitPart {
  int right, below;  ///< the last columns and rows
};

/// Σ of squares of what interpolation along one axis adds to the kernel at a place. \param at  of the place,
/// in cells of the axis. \param kernel_there  the kernel at a place of the axis.
template <typename KernelThere>
double squared_error(const Kernel& exact, const LitPart& lit, int at, int tile,
                     const std::vector<double>& nodes, const KernelThere& kernel_there) {
  const int first = at / tile * tile;
  const std::vector<double> weights = lagrange_weights(nodes, double(at - first) / tile);
  std::vector<double> difference = exact.weights;
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    if (weights[a] == 0) continue;
    const Kernel kernel = kernel_there(first + tile * nodes[a]);
    for (std::size_t i = 0; i < difference.size(); ++i) difference[i] -= weights[a] * kernel.weights[i];
  }
  double sum = 0;
  for (int row = -exact.radius; row <= lit.below; ++row) {
    const double* values =
        difference.data() + static_cast<std::ptrdiff_t>(row + exact.radius) * exact.size() + exact.radius;
    for (int column = -exact.radius; column <= lit.right; ++column) sum += values[column] * values[column];
  }
  return sum;
}

enum class Axis { across, down };

struct Layout {
  int tile;
  std::vector<double> nodes;

  Layout(int side, int count) : tile(side), nodes(lobatto_nodes(count)) {}
};

/// Of layouts of tiles, at cells counted outwards.
class ErrorAtPlaces {
 public:
  ErrorAtPlaces(const PsfField& psfs, const SourceGrid& grid)
      : psfs_(psfs),
        across_(grid.cells.columns),
        down_(grid.cells.rows),
        margin_(grid.margin),
        look_(grid.look),
        zone_(grid.zone) {}
  const PsfField& psfs() const { return psfs_; }
  double radius(int column, int row) const {
    return std::hypot(across_.position(column), down_.position(row));
  }
  bool in_zone(int column, int row) const { return zone_.holds(radius(column, row)); }
  bool symmetric() const { return psfs_.symmetry() != KernelSymmetry::none; }
  const OutwardAxis& across() const { return across_; }
  const OutwardAxis& down() const { return down_; }
  int columns_in_picture() const { return std::max(1, across_.count() - margin_); }
  int rows_in_picture() const { return std::max(1, down_.count() - margin_); }
  /// What the square of the error of a cell counts: the square of its light, in units of any size.
  double weight(int column, int row, const Quadrant& quadrant = {true, true}) const {
    if (look_ == nullptr) return 1;
    const std::array<double, 2> place = place_mm(psfs_, across_, down_, column, row, quadrant);
    const double light = look_->place(place[0], place[1]).g_source_sr;
    return light * light;
  }
  /// Σd²/(1 + Σh²) of what interpolation along one axis adds. \param quadrant  where the cell lies.
  /// \param kept  its true kernel, if it is known, and for the next time.
  double square_along(Axis axis, const Layout& layout, int column, int row, const Quadrant& quadrant,
                      Kernel& kept) const {
    constexpr std::size_t most_kept = 100'000;  // weights of a kernel: of all places 90 MB
    Kernel made = kept.weights.empty() ? kernel(column, row, quadrant) : Kernel();
    if (kept.weights.empty() && made.weights.size() <= most_kept) kept = std::move(made);
    const Kernel& exact = kept.weights.empty() ? made : kept;
    double square = 0;
    for (const double weight : exact.weights) square += weight * weight;
    const auto last = [&](const OutwardAxis& along, int at) {
      return std::min(exact.radius, along.count() - margin_ - 1 - at);
    };
    const LitPart lit{last(across_, column), last(down_, row)};
    const double error = axis == Axis::across
                             ? squared_error(exact, lit, column, layout.tile, layout.nodes,
                                             [&](double at) { return kernel(at, row, quadrant); })
                             : squared_error(exact, lit, row, layout.tile, layout.nodes,
                                             [&](double at) { return kernel(column, at, quadrant); });
    return error / (1 + square);
  }

 private:
  Kernel kernel(double column, double row, const Quadrant& quadrant) const {
    return kernel_at_node(psfs_, across_, down_, column, row, quadrant);
  }

  const PsfField& psfs_;
  OutwardAxis across_, down_;
  int margin_;
  const SceneLook* look_;
  CellRing zone_;
};

/// A cell of a quadrant.
struct Place {
  double radius, weight;  ///< the weight's mean over the picture is 1
  int column, row;
};

/// Cells of the picture, evenly over a quadrant, that lie within a radius, the outermost first, and their
/// share of all.
struct Places {
  std::vector<Place> inside;
  double share = 0;
};
Places places_within(const ErrorAtPlaces& errors, double radius) {
  constexpr int most = 128;  // along a side
  const int columns = errors.columns_in_picture(), rows = errors.rows_in_picture();
  const int across = (columns + most - 1) / most, down = (rows + most - 1) / most;
  Places places;
  std::size_t all = 0;
  double weights = 0;
  for (int row = down / 2; row < rows; row += down)
    for (int column = across / 2; column < columns; column += across) {
      const double x = errors.across().position(column), y = errors.down().position(row);
      const double r = std::sqrt(x * x + y * y), weight = errors.weight(column, row);
      if (r < radius && errors.in_zone(column, row)) places.inside.push_back({r, weight, column, row});
      weights += weight;
      ++all;
    }
  if (weights > 0)
    for (Place& place : places.inside) place.weight *= double(all) / weights;
  // Shells reach no farther in than an eighth of them.
  const auto eighth = places.inside.begin() + static_cast<std::ptrdiff_t>((places.inside.size() + 7) / 8);
  const auto outer = [](const Place& a, const Place& b) {
    return std::tuple(-a.radius, a.row, a.column) < std::tuple(-b.radius, b.row, b.column);
  };
  if (eighth != places.inside.end())
    std::nth_element(places.inside.begin(), eighth, places.inside.end(), outer);
  std::sort(places.inside.begin(), eighth, outer);
  places.share = double(places.inside.size()) / double(all);
  return places;
}

/// A cell that light comes from.
struct LitPlace {
  int column, row;
  Quadrant quadrant;
  double weight;  ///< the weights' mean over all that is lit, in the zone or not, is 1
};

/// Places of a zone, and its share of what is lit.
struct LitPlaces {
  std::vector<LitPlace> inside;
  double share = 1;
};

/// Evenly over what is lit of the grid, in an order in which any number of first places is spread over it.
LitPlaces lit_places(const ErrorAtPlaces& errors) {
  constexpr int most_tried = 64 * KernelError::places;
  LitPlaces places;
  double weights = 0, all = 0;
  for (int i = 1; i <= most_tried && places.inside.size() < KernelError::places; ++i) {
    LitPlace place{static_cast<int>(radical_inverse(i, 2) * errors.across().count()),
                   static_cast<int>(radical_inverse(i, 3) * errors.down().count()),
                   {true, true},
                   0};
    // Quadrant after quadrant, in another order than that of columns.
    const int turn = i + i / 4;
    if (!errors.symmetric()) place.quadrant = {turn % 2 == 0, turn / 2 % 2 == 0};
    place.weight = errors.weight(place.column, place.row, place.quadrant);
    if (place.weight == 0) continue;
    weights += place.weight;
    ++all;
    if (errors.in_zone(place.column, place.row)) places.inside.push_back(place);
  }
  for (LitPlace& place : places.inside) place.weight *= all / weights;
  if (all > 0) places.share = double(places.inside.size()) / all;
  return places;
}

}  // namespace

class LayoutErrors::Impl {
 public:
  Impl(const PsfField& psfs, const SourceGrid& grid)
      : errors_(psfs, grid), places_(lit_places(errors_)), exact_(count()), order_(count()) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
  }

  std::size_t count() const { return places_.inside.size(); }
  double share() const { return places_.share; }

  /// Of the first few places, weighted.
  std::vector<double> first_squares(const Layout& layout, std::size_t few) {
    std::vector<double> squares(std::min(few, count()));
    parallel_for(squares.size(), [&](std::size_t i) { squares[i] = square(layout, i); });
    return squares;
  }

  KernelError at_places(const Layout& layout, double limit) {
    const double most = limit * limit * double(std::max<std::size_t>(1, count())) / share();
    KernelError error;
    // What was the worst of another layout comes first: most layouts that fail do so there.
    if (worst_axis_ && count() > 0) {
      const double worst = square_along(*worst_axis_, layout, order_[0]);
      error.rms = std::sqrt(share() * worst / double(count()));
      if (worst > most) return error;
    }
    std::size_t at_once = worst_axis_ ? 2 : KernelError::first_places;
    std::vector<std::array<double, 2>> along(count());  // across and down
    std::vector<double> squares(count());
    double sum = 0;
    for (std::size_t first = 0, end = 0; first < count() && !(sum > most); first = end) {
      end = std::min(count(), first + at_once);
      at_once = KernelError::first_places;
      parallel_for(end - first, [&](std::size_t i) {
        const std::size_t place = order_[first + i];
        along[place] = {square_along(Axis::across, layout, place), square_along(Axis::down, layout, place)};
        squares[place] = along[place][0] + along[place][1];
      });
      for (std::size_t i = first; i < end; ++i) sum += squares[order_[i]];
    }
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::size_t a, std::size_t b) { return squares[a] > squares[b]; });
    if (count() > 0) worst_axis_ = along[order_[0]][0] > along[order_[0]][1] ? Axis::across : Axis::down;
    std::copy_n(squares.begin(), std::min<std::size_t>(count(), KernelError::first_places),
                error.first_squares.begin());
    const double total = std::accumulate(squares.begin(), squares.end(), 0.0);
    error.rms = std::sqrt(share() * total / double(std::max<std::size_t>(1, count())));
    return error;
  }

  RimError at_rim(const Layout& layout, double limit);
  bool does_with_less(const Layout& layout, double limit, const CellRing& ring);
  /// The mean square error in the outermost cells; nothing if the rim is too small to be looked at.
  std::optional<double> outermost(const Layout& layout);

 private:
  double square_along(Axis axis, const Layout& layout, std::size_t index) {
    const LitPlace& place = places_.inside[index];
    return place.weight *
           errors_.square_along(axis, layout, place.column, place.row, place.quadrant, exact_[index]);
  }
  double square(const Layout& layout, std::size_t index) {
    return square_along(Axis::across, layout, index) + square_along(Axis::down, layout, index);
  }
  /// Cells of the picture inside the last height of a table, the outermost first.
  const std::vector<Place>& rim() {
    if (!rim_)
      rim_ = places_within(errors_, errors_.psfs().rim_mm() / (errors_.psfs().cell_um() * mm_per_um) + 1);
    return rim_->inside;
  }
  bool rim_is_too_small() {
    constexpr std::size_t fewest_places = 64;
    return rim().size() < fewest_places;
  }
  /// The first place behind shell k, from the rim inwards: each is as large as all outside it, a thousandth
  /// of the cells to an eighth.
  std::size_t end_of_shell(std::size_t k) { return (rim().size() << k) / 1024; }
  double share_of(std::size_t from, std::size_t to) {
    return rim_->share * double(to - from) / double(rim().size());
  }
  /// The square of the error at one of the places [from, to) of a shell that are looked at, weighted.
  double square_in_shell(const Layout& layout, std::size_t shell, std::size_t from, std::size_t to,
                         std::size_t i) {
    const std::size_t few = places_looked_at(from, to);
    const Place& place = rim()[from + (2 * i + 1) * (to - from) / (2 * few)];
    if (place.weight == 0) return 0;
    const auto along = [&](Axis axis) {
      return errors_.square_along(axis, layout, place.column, place.row, {true, true}, rim_exact_[shell][i]);
    };
    return place.weight * (along(Axis::across) + along(Axis::down));
  }
  static std::size_t places_looked_at(std::size_t from, std::size_t to) {
    return std::min(places_a_shell, to - from);
  }
  /// Their mean.
  double square_of_shell(const Layout& layout, std::size_t shell, std::size_t from, std::size_t to) {
    rim();  // made by one thread
    const std::size_t few = places_looked_at(from, to);
    std::array<double, places_a_shell> squares{};
    parallel_for(few, [&](std::size_t i) { squares[i] = square_in_shell(layout, shell, from, to, i); });
    return std::accumulate(squares.begin(), squares.end(), 0.0) / double(few);
  }

  static constexpr std::size_t most_shells = 8, places_a_shell = 6;
  ErrorAtPlaces errors_;
  LitPlaces places_;
  std::vector<Kernel> exact_;
  std::vector<std::size_t> order_;
  std::optional<Axis> worst_axis_;  ///< at the first place of that order
  std::optional<Places> rim_;
  std::array<std::array<Kernel, places_a_shell>, most_shells> rim_exact_;
};

RimError LayoutErrors::Impl::at_rim(const Layout& layout, double limit) {
  RimError error;
  if (rim_is_too_small()) return error;
  struct Shell {
    double inner_radius, square;  ///< of the whole grid
  };
  std::vector<Shell> shells;
  std::size_t from = 0;
  double rest = 0, worst = 0;
  for (std::size_t k = 0; k < most_shells; ++k) {
    const std::size_t to = std::max(from + 1, end_of_shell(k));
    const double share = share_of(from, to), square = square_of_shell(layout, k, from, to);
    shells.push_back({rim()[to].radius, share * square});
    rest += share * square;
    worst = std::max(worst, square);
    from = to;
    if (k == 0) error.outermost = square;
    // Where the outermost are not worse than others, there is nothing about the rim.
    constexpr double usual = 4;
    if (k == 1 && worst < usual * limit * limit) return error;
  }
  for (const Shell& shell : shells) {
    if (rest <= limit * limit) break;
    rest -= shell.square;
    // A tile may begin inside.
    error.ring = {shell.inner_radius, rim().front().radius + 2.0 * layout.tile};
  }
  error.within = rest <= limit * limit;
  error.mean_square = std::max(0.0, rest);
  return error;
}

/// The shells of a ring but its innermost are left out already: with that one left in, the error must stay
/// within the limit.
bool LayoutErrors::Impl::does_with_less(const Layout& layout, double limit, const CellRing& ring) {
  std::size_t from = 0;
  for (std::size_t k = 0; k < most_shells; ++k) {
    const std::size_t to = std::max(from + 1, end_of_shell(k));
    if (rim()[to].radius <= ring.from) {
      const std::size_t few = places_looked_at(from, to);
      const double most = limit * limit * double(few) / share_of(from, to);
      double sum = 0;
      for (std::size_t i = 0; i < few && !(sum > most); ++i) sum += square_in_shell(layout, k, from, to, i);
      return !(sum > most);
    }
    from = to;
  }
  return true;
}

std::optional<double> LayoutErrors::Impl::outermost(const Layout& layout) {
  if (rim_is_too_small()) return {};
  return square_of_shell(layout, 0, 0, std::max<std::size_t>(1, end_of_shell(0)));
}

LayoutErrors::LayoutErrors(const PsfField& psfs, const SourceGrid& grid)
    : impl_(std::make_unique<Impl>(psfs, grid)) {}
LayoutErrors::~LayoutErrors() = default;

KernelError LayoutErrors::at_places(int tile, int nodes, double limit) {
  return impl_->at_places({tile, nodes}, limit);
}

RimError LayoutErrors::at_rim(int tile, int nodes, double limit) {
  return impl_->at_rim({tile, nodes}, limit);
}

bool LayoutErrors::does_with_less(int tile, int nodes, double limit, const CellRing& ring) {
  return impl_->does_with_less({tile, nodes}, limit, ring);
}

KernelError kernel_error(const PsfField& psfs, const SourceGrid& grid, int tile, int nodes, double limit) {
  return LayoutErrors(psfs, grid).at_places(tile, nodes, limit);
}

KernelError LayoutErrors::at_places_like(const KernelError& known, int tile, int nodes, int few) {
  KernelError error;
  std::array<double, KernelError::first_places>& squares = error.first_squares;
  std::ranges::copy(impl_->first_squares({tile, nodes}, static_cast<std::size_t>(few)), squares.begin());
  const double now = std::accumulate(squares.begin(), squares.begin() + few, 0.0),
               before = std::accumulate(known.first_squares.begin(), known.first_squares.begin() + few, 0.0);
  const double change = before > 0 ? now / before : 1;
  std::transform(known.first_squares.begin() + few, known.first_squares.end(), squares.begin() + few,
                 [&](double square) { return square * change; });
  error.rms = before > 0 ? known.rms * std::sqrt(change) : std::sqrt(impl_->share() * now / few);
  return error;
}

RimError LayoutErrors::at_rim_like(const RimError& known, int tile, int nodes, double limit) {
  if (!known.ring.empty()) return at_rim(tile, nodes, limit);
  RimError rim;
  const std::optional<double> outermost = impl_->outermost({tile, nodes});
  if (!outermost) return rim;
  rim.outermost = *outermost;
  const double change = known.outermost > 0 ? rim.outermost / known.outermost : 1;
  // The rest of a rim need not follow its outermost cells that far.
  constexpr double far = 2;
  if (change > far) return at_rim(tile, nodes, limit);
  rim.mean_square = known.mean_square * change;
  rim.within = rim.mean_square <= limit * limit;
  return rim;
}

KernelError kernel_error_like(const KernelError& known, const PsfField& psfs, const SourceGrid& grid,
                              int tile, int nodes, int few) {
  return LayoutErrors(psfs, grid).at_places_like(known, tile, nodes, few);
}

}  // namespace petzval
