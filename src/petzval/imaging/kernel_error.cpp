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

/// Of a layout of tiles, at cells counted outwards.
class ErrorAtPlaces {
 public:
  ErrorAtPlaces(const PsfField& psfs, const SourceGrid& grid, int tile, int nodes)
      : psfs_(psfs),
        across_(grid.cells.columns),
        down_(grid.cells.rows),
        margin_(grid.margin),
        look_(grid.look),
        tile_(tile),
        nodes_(lobatto_nodes(nodes)) {}
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
  /// Σd²/(1 + Σh²). \param quadrant  where the cell lies.
  double square(int column, int row, const Quadrant& quadrant = {true, true}) const {
    const Kernel exact = kernel(column, row, quadrant);
    double square = 0;
    for (const double weight : exact.weights) square += weight * weight;
    const auto last = [&](const OutwardAxis& axis, int at) {
      return std::min(exact.radius, axis.count() - margin_ - 1 - at);
    };
    const LitPart lit{last(across_, column), last(down_, row)};
    const auto along_row = [&](double at) { return kernel(at, row, quadrant); };
    const auto along_column = [&](double at) { return kernel(column, at, quadrant); };
    return (squared_error(exact, lit, column, tile_, nodes_, along_row) +
            squared_error(exact, lit, row, tile_, nodes_, along_column)) /
           (1 + square);
  }

 private:
  Kernel kernel(double column, double row, const Quadrant& quadrant) const {
    return kernel_at_node(psfs_, across_, down_, column, row, quadrant);
  }

  const PsfField& psfs_;
  OutwardAxis across_, down_;
  int margin_;
  const SceneLook* look_;
  int tile_;
  std::vector<double> nodes_;
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
  constexpr int most = 256;  // along a side
  const int columns = errors.columns_in_picture(), rows = errors.rows_in_picture();
  const int across = (columns + most - 1) / most, down = (rows + most - 1) / most;
  Places places;
  std::size_t all = 0;
  double weights = 0;
  for (int row = down / 2; row < rows; row += down)
    for (int column = across / 2; column < columns; column += across) {
      const double x = errors.across().position(column), y = errors.down().position(row);
      const double r = std::sqrt(x * x + y * y), weight = errors.weight(column, row);
      if (r < radius) places.inside.push_back({r, weight, column, row});
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

/// The mean square error, weighted, over some of the places [from, to).
double mean_square(const ErrorAtPlaces& errors, const std::vector<Place>& places, std::size_t from,
                   std::size_t to) {
  constexpr std::size_t most = 6;
  const std::size_t count = std::min(most, to - from);
  std::array<double, most> squares{};
  parallel_for(count, [&](std::size_t i) {
    const Place& place = places[from + (2 * i + 1) * (to - from) / (2 * count)];
    squares[i] = place.weight == 0 ? 0 : place.weight * errors.square(place.column, place.row);
  });
  double sum = 0;
  for (const double square : squares) sum += square;
  return sum / double(count);
}

}  // namespace

namespace {

/// A cell that light comes from.
struct LitPlace {
  int column, row;
  Quadrant quadrant;
  double weight;  ///< the weights' mean is 1
};

/// Evenly over what is lit of the grid, in an order in which any number of first places is spread over it.
std::vector<LitPlace> lit_places(const ErrorAtPlaces& errors) {
  constexpr int most_tried = 64 * KernelError::places;
  std::vector<LitPlace> places;
  double weights = 0;
  for (int i = 1; i <= most_tried && places.size() < KernelError::places; ++i) {
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
    places.push_back(place);
  }
  for (LitPlace& place : places) place.weight *= double(places.size()) / weights;
  return places;
}

double weighted_square(const ErrorAtPlaces& errors, const LitPlace& place) {
  return place.weight * errors.square(place.column, place.row, place.quadrant);
}

}  // namespace

KernelError kernel_error(const PsfField& psfs, const SourceGrid& grid, int tile, int nodes, double limit) {
  const ErrorAtPlaces errors(psfs, grid, tile, nodes);
  const std::vector<LitPlace> places = lit_places(errors);
  constexpr std::size_t at_once = KernelError::first_places;
  KernelError error;
  double total = 0;
  for (std::size_t first = 0; first < places.size(); first += at_once) {
    std::array<double, at_once> squares{};
    parallel_for(std::min(at_once, places.size() - first),
                 [&](std::size_t i) { squares[i] = weighted_square(errors, places[first + i]); });
    for (const double square : squares) total += square;
    if (first == 0) error.first_squares = squares;
    if (total > limit * limit * double(places.size())) break;
  }
  error.rms = std::sqrt(total / double(std::max<std::size_t>(1, places.size())));
  return error;
}

KernelError kernel_error_like(const KernelError& known, const PsfField& psfs, const SourceGrid& grid,
                              int tile, int nodes, int few) {
  const ErrorAtPlaces errors(psfs, grid, tile, nodes);
  KernelError error;
  std::array<double, KernelError::first_places>& squares = error.first_squares;
  const std::vector<LitPlace> places = lit_places(errors);
  parallel_for(std::min(static_cast<std::size_t>(few), places.size()),
               [&](std::size_t i) { squares[i] = weighted_square(errors, places[i]); });
  const double now = std::accumulate(squares.begin(), squares.begin() + few, 0.0),
               before = std::accumulate(known.first_squares.begin(), known.first_squares.begin() + few, 0.0);
  const double change = before > 0 ? now / before : 1;
  std::transform(known.first_squares.begin() + few, known.first_squares.end(), squares.begin() + few,
                 [&](double square) { return square * change; });
  error.rms = before > 0 ? known.rms * std::sqrt(change) : std::sqrt(now / few);
  return error;
}

namespace {

/// Cells of the picture inside the last height of a table, the outermost first, and shells of them.
class Rim {
 public:
  Rim(const PsfField& psfs, const SourceGrid& grid, int tile, int nodes)
      : errors_(psfs, grid, tile, nodes),
        sampled_(places_within(errors_, psfs.rim_mm() / (psfs.cell_um() * mm_per_um) + 1)) {}

  const std::vector<Place>& places() const { return sampled_.inside; }
  bool is_too_small() const {
    constexpr std::size_t fewest_places = 64;
    return places().size() < fewest_places;
  }
  /// The first place behind shell k, from the rim inwards: each is as large as all outside it, a thousandth
  /// of the cells to an eighth.
  std::size_t end_of_shell(int k) const { return (places().size() << k) / 1024; }
  double share(std::size_t from, std::size_t to) const {
    return sampled_.share * double(to - from) / double(places().size());
  }
  double square(std::size_t from, std::size_t to) const { return mean_square(errors_, places(), from, to); }

 private:
  ErrorAtPlaces errors_;
  Places sampled_;
};

}  // namespace

RimError rim_error(const PsfField& psfs, const SourceGrid& grid, int tile, int nodes, double limit) {
  const Rim cells(psfs, grid, tile, nodes);
  RimError rim;
  if (cells.is_too_small()) return rim;

  constexpr int most_shells = 8;
  struct Shell {
    double inner_radius, square;  ///< of the whole grid
  };
  std::vector<Shell> shells;
  std::size_t from = 0;
  double rest = 0, worst = 0;
  for (int k = 0; k < most_shells; ++k) {
    const std::size_t to = std::max(from + 1, cells.end_of_shell(k));
    const double share = cells.share(from, to), square = cells.square(from, to);
    shells.push_back({cells.places()[to].radius, share * square});
    rest += share * square;
    worst = std::max(worst, square);
    from = to;
    if (k == 0) rim.outermost = square;
    // Where the outermost are not worse than others, there is nothing about the rim.
    constexpr double usual = 4;
    if (k == 1 && worst < usual * limit * limit) return rim;
  }
  for (const Shell& shell : shells) {
    if (rest <= limit * limit) break;
    rest -= shell.square;
    rim.ring = {shell.inner_radius, cells.places().front().radius + 2.0 * tile};  // a tile that begins inside
  }
  rim.within = rest <= limit * limit;
  rim.mean_square = std::max(0.0, rest);
  return rim;
}

RimError rim_error_like(const RimError& known, const PsfField& psfs, const SourceGrid& grid, int tile,
                        int nodes, double limit) {
  if (!known.ring.empty()) return rim_error(psfs, grid, tile, nodes, limit);
  const Rim cells(psfs, grid, tile, nodes);
  RimError rim;
  if (cells.is_too_small()) return rim;
  rim.outermost = cells.square(0, std::max<std::size_t>(1, cells.end_of_shell(0)));
  const double change = known.outermost > 0 ? rim.outermost / known.outermost : 1;
  // The rest of a rim need not follow its outermost cells that far.
  constexpr double far = 2;
  if (change > far) return rim_error(psfs, grid, tile, nodes, limit);
  rim.mean_square = known.mean_square * change;
  rim.within = rim.mean_square <= limit * limit;
  return rim;
}

}  // namespace petzval
