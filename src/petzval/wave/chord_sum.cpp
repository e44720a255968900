// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/numeric/quadrature.h>
#include <petzval/wave/cell_light.h>
#include <petzval/wave/chord_kernel.h>
#include <petzval/wave/chord_sum.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace petzval {

namespace {

constexpr int most_samples = 1 << 14;
/// Rules of this many nodes, and multiples of it up to the largest; more phase takes several panels.
constexpr int rule_step = 8, largest_rule = 256;
constexpr double largest_degree = 468;  ///< of the largest rule

/// Nodes that integrate polynomials of this degree, and what e^{ibx}, |b| ≤ degree, has beyond it, to 1e-7,
/// which is what single precision leaves of the sum: n nodes take degree 2n − 1, and O(b^⅓) more are needed
/// (6.5 by trial, b from 10 to 400).
int nodes_for(double degree) {
  return static_cast<int>(std::ceil(0.5 * (degree + 6.5 * std::cbrt(degree)))) + 1;
}

/// The Gauss-Legendre rule on [0, 1] of so many nodes, or a few more.
const QuadratureRule& rule_of(int nodes) {
  static const std::vector<QuadratureRule> all = [] {
    std::vector<QuadratureRule> made;
    for (int n = rule_step; n <= largest_rule; n += rule_step) made.push_back(gauss_legendre(n));
    return made;
  }();
  return all[std::min(static_cast<std::size_t>((nodes + rule_step - 1) / rule_step), all.size()) - 1];
}

/// Gauss-Legendre panels on [from, to] for waves of this degree over all of it.
QuadratureRule panels(double from, double to, double degree) {
  const int count = std::max(1, static_cast<int>(std::ceil(degree / largest_degree)));
  const QuadratureRule& unit = rule_of(nodes_for(degree / count));
  const double width = (to - from) / count;
  QuadratureRule rule;
  for (int p = 0; p < count; ++p)
    for (std::size_t j = 0; j < unit.nodes.size(); ++j) {
      rule.nodes.push_back(from + (p + unit.nodes[j]) * width);
      rule.weights.push_back(unit.weights[j] * width);
    }
  return rule;
}

/// The samples that are wanted, about the chief ray's point [mm].
struct Window {
  double reach_s, low_t, high_t;
};

/// Where chords are to be summed so that their sum over β is right in all of a window.
///
/// The waves e^{ikβt} F(β) turn with β as the paths to the ends of the chords do, φ(h, β) + h s + β t, and by
/// the rays in between. In the angle ψ of x = cos ψ on [−1, 1], the most of that is the degree of polynomials
/// in x that a rule must integrate. At the two ends of a pupil chords shrink like square roots, which rules
/// take into their weights: Gauss-Chebyshev of the second kind for a pupil without corners (Abramowitz &
/// Stegun 25.4.40), Gauss-Jacobi of weight √u by u = y² and the positive half of a Gauss-Legendre rule
/// between an end and a corner, Gauss-Legendre between corners; or Gauss-Legendre over θ, β = middle + half ·
/// cos θ in the whole pupil. Whichever takes the fewest.
class ChordNodes {
 public:
  ChordNodes(const SmoothPupil& pupil, const Window& window)
      : pupil_(pupil),
        middle_(0.5 * (pupil.beta_high() + pupil.beta_low())),
        half_(0.5 * (pupil.beta_high() - pupil.beta_low())) {
    const double k = 2 * pi * pupil.image_index / (pupil.wavelength_nm * mm_per_nm);
    turn_t_ = k * std::max(window.high_t - pupil.low_t_mm, pupil.high_t_mm - window.low_t);
    for (std::size_t i = 0; i < pupil.outline_beta.size(); ++i) {
      const double alpha = pupil.outline_alpha[i], beta = pupil.outline_beta[i];
      const double phase = 2 * pi * pupil.phase_waves(alpha, beta), s = k * alpha * window.reach_s;
      const double high = phase + k * beta * window.high_t, low = phase + k * beta * window.low_t;
      waves_.push_back({high + s, high - s, low + s, low - s});
    }
  }

  QuadratureRule all() const {
    std::vector<std::size_t> ends{0};
    ends.insert(ends.end(), pupil_.corners.begin(), pupil_.corners.end());
    ends.push_back(pupil_.outline_beta.size() - 1);
    if (ends.size() == 2) return whole();
    QuadratureRule rule;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
      const QuadratureRule more = piece(ends[i], ends[i + 1]);
      rule.nodes.insert(rule.nodes.end(), more.nodes.begin(), more.nodes.end());
      rule.weights.insert(rule.weights.end(), more.weights.begin(), more.weights.end());
    }
    return rule;
  }

 private:
  /// The largest change of a wave from one point of the outline to the next against that of a coordinate.
  template <class Coordinate>
  double degree(std::size_t first, std::size_t last, const Coordinate& coordinate) const {
    double most = 0, at = coordinate(pupil_.outline_beta[first]);
    for (std::size_t i = first + 1; i <= last; ++i) {
      const double next = coordinate(pupil_.outline_beta[i]);
      double change = turn_t_ * std::abs(pupil_.outline_beta[i] - pupil_.outline_beta[i - 1]);
      for (std::size_t w = 0; w < waves_[i].size(); ++w)
        change = std::max(change, std::abs(waves_[i][w] - waves_[i - 1][w]));
      most = std::max(most, change / std::abs(next - at));
      at = next;
    }
    return most;
  }
  static double angle(double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)); }
  double theta(double beta) const { return angle((beta - middle_) / half_); }

  QuadratureRule whole() const {
    const std::size_t last = pupil_.outline_beta.size() - 1;
    const double steps = nodes_for(degree(0, last, [&](double beta) { return theta(beta); })) + 1;
    QuadratureRule rule;
    for (double k = 1; k < steps; ++k) {
      rule.nodes.push_back(middle_ + half_ * std::cos(pi * k / steps));
      rule.weights.push_back(half_ * std::sin(pi * k / steps) * pi / steps);
    }
    return rule;
  }

  QuadratureRule piece(std::size_t first, std::size_t last) const {
    const bool at_top = first == 0, at_bottom = last + 1 == pupil_.outline_beta.size();
    const double high = pupil_.outline_beta[first], low = pupil_.outline_beta[last];
    const double from = theta(high), width = theta(low) - from;
    const auto x_of_theta = [&](double beta) { return 2 * (theta(beta) - from) / width - 1; };
    const double over_theta = degree(first, last, [&](double beta) { return angle(x_of_theta(beta)); });
    if (at_top || at_bottom) {
      const double end = at_top ? high : low, span = at_top ? low - high : high - low;
      const double most = degree(
          first, last, [&](double beta) { return angle(std::sqrt(std::max((beta - end) / span, 0.0))); });
      if (most < 2 * over_theta && most < largest_degree) return from_end(end, span, most);
    } else {
      const double most =
          degree(first, last, [&](double beta) { return angle((2 * beta - high - low) / (high - low)); });
      if (most < over_theta && most < largest_degree) return panels(low, high, most);
    }
    const double most = over_theta < largest_degree ? over_theta : degree(first, last, x_of_theta);
    QuadratureRule rule = panels(from, from + width, most);
    for (std::size_t j = 0; j < rule.nodes.size(); ++j) {
      rule.weights[j] *= half_ * std::sin(rule.nodes[j]);
      rule.nodes[j] = middle_ + half_ * std::cos(rule.nodes[j]);
    }
    return rule;
  }

  static QuadratureRule from_end(double end, double span, double most) {
    const QuadratureRule& unit = rule_of(nodes_for(most));
    QuadratureRule rule;
    for (std::size_t j = unit.nodes.size() / 2; j < unit.nodes.size(); ++j) {
      const double y = 2 * unit.nodes[j] - 1;
      rule.nodes.push_back(end + span * y * y);
      rule.weights.push_back(std::abs(span) * 4 * y * unit.weights[j]);
    }
    return rule;
  }

  const SmoothPupil& pupil_;
  double middle_, half_, turn_t_ = 0;
  std::vector<std::array<double, 4>> waves_;  ///< phases at the outline, towards the window's corners [rad]
};

struct Chord {
  double beta, weight, half;
};

/// The chords of a pupil, longest first, so that those summed together need about the same nodes.
std::vector<Chord> chords_of(const SmoothPupil& pupil, const Window& window) {
  std::vector<Chord> chords;
  const QuadratureRule betas = ChordNodes(pupil, window).all();
  for (std::size_t j = 0; j < betas.nodes.size(); ++j)
    if (const double half = pupil.half_chord(betas.nodes[j]); half > 0)
      chords.push_back({betas.nodes[j], betas.weights[j], half});
  std::stable_sort(chords.begin(), chords.end(),
                   [](const Chord& a, const Chord& b) { return a.half > b.half; });
  return chords;
}

void take_chords(const SmoothPupil& pupil, std::vector<Chord> chords, double turn_s, ChordSum& sum) {
  if (chords.empty()) return;
  constexpr std::size_t together = ChordSum::chords_together;
  // About the pupil's middle, so that U turns no faster than half a pupil's width makes it.
  const double middle = 0.5 * (pupil.beta_high() + pupil.beta_low());
  const Chord shortest = chords.back();
  while (chords.size() % together != 0) chords.push_back({shortest.beta, 0, shortest.half});
  sum.terms = pupil.phase_waves.terms();
  sum.alpha_scale = pupil.phase_waves.x_scale();
  sum.phase.resize(sum.terms * chords.size());
  sum.amplitude.resize(sum.terms * chords.size());
  std::vector<double> phase(sum.terms), amplitude(sum.terms);
  for (std::size_t i = 0; i < chords.size(); ++i) {
    const Chord& chord = chords[i];
    sum.beta.push_back(chord.beta - middle);
    sum.strength.push_back(static_cast<float>(2 * chord.half * chord.weight));
    sum.half_chord.push_back(chord.half);
    if (i % together == 0) sum.along.push_back(panels(0, 1, 0.5 * turn_s * chord.half));
    pupil.phase_waves.series(chord.beta, phase);
    pupil.amplitude.series(chord.beta, amplitude);
    for (std::size_t m = 0; m < sum.terms; ++m) {
      sum.phase[m * chords.size() + i] = phase[m];
      sum.amplitude[m * chords.size() + i] = static_cast<float>(amplitude[m]);
    }
  }
}

/// The cells to sum: rows [first, first + count) and columns 0 … reach right of the middle.
struct Lit {
  int first_row, rows, reach;

  explicit Lit(const PsfGrid& grid)
      : first_row(std::clamp(grid.first_row, 0, grid.size - 1)),
        rows((grid.last_row < 0 ? grid.size : std::clamp(grid.last_row + 1, first_row + 1, grid.size)) -
             first_row),
        reach(grid.reach < 0 ? grid.size / 2 : std::min(grid.reach, grid.size / 2)) {}
};

/// Columns of cells with s ≥ 0: the rest is their mirror image.
CellGrid cell_grid(const SmoothPupil& pupil, const PsfGrid& grid, const Lit& lit) {
  const double lambda_mm = pupil.wavelength_nm * mm_per_nm / pupil.image_index;
  const double step_mm = grid.sample_spacing_um() * mm_per_um;
  CellGrid cells;
  cells.cell = grid.samples_per_cell;
  cells.rows = lit.rows * cells.cell;
  cells.columns = (lit.reach + 1) * cells.cell;
  cells.along_s = FinerSamples::of_step(step_mm * 2 * pupil.alpha_max() / lambda_mm);
  cells.along_t = FinerSamples::of_step(step_mm * (pupil.beta_high() - pupil.beta_low()) / lambda_mm);
  return cells;
}

ChordSum chord_sum(const SmoothPupil& pupil, const PsfGrid& grid, const Lit& lit, const CellGrid& cells) {
  const double step_mm = grid.sample_spacing_um() * mm_per_um;
  const double first_of_cell_mm = -0.5 * (cells.cell - 1) * step_mm;
  ChordSum sum;
  sum.waves_per_mm = pupil.image_index / (pupil.wavelength_nm * mm_per_nm);
  sum.column_step_mm = cells.along_s.factor * step_mm;
  sum.row_step_mm = cells.along_t.factor * step_mm;
  sum.columns = cells.along_s.needed(cells.columns);
  sum.rows = cells.along_t.needed(cells.rows);
  sum.first_column_mm = first_of_cell_mm - cells.along_s.before() * sum.column_step_mm;
  sum.first_row_mm = first_of_cell_mm + (lit.first_row - grid.size / 2) * grid.spacing_um * mm_per_um -
                     cells.along_t.before() * sum.row_step_mm;
  const Window window{sum.first_column_mm + sum.columns * sum.column_step_mm,
                      sum.first_row_mm - sum.row_step_mm, sum.first_row_mm + sum.rows * sum.row_step_mm};
  const double k = 2 * pi * sum.waves_per_mm;
  take_chords(pupil, chords_of(pupil, window), k * (window.reach_s + pupil.reach_s_mm), sum);
  return sum;
}

}  // namespace

Psf sum_chords(const SmoothPupil& pupil, const PsfGrid& grid) {
  if (grid.size < 1 || !(grid.spacing_um > 0) || grid.samples_per_cell < 1 ||
      grid.size > most_samples / grid.samples_per_cell)
    throw InputError(fmt::format("a PSF needs at least one sample, at most {} a side, and a positive spacing",
                                 most_samples));
  const Lit lit(grid);
  const CellGrid in_cells = cell_grid(pupil, grid, lit);
  const ChordSum sum = chord_sum(pupil, grid, lit, in_cells);
  std::vector<double> cells;
  sum_cell_light(sum_chord_waves(sum), in_cells, cells);

  const auto columns = static_cast<std::size_t>(lit.reach + 1);
  // The first column of an even size has no partner on the right.
  const std::size_t alone = grid.size % 2 == 0 && lit.reach == grid.size / 2 ? columns - 1 : columns;
  double total = 0;
  for (std::size_t row = 0; row < cells.size(); row += columns)
    for (std::size_t j = 0; j < columns; ++j) total += (j == 0 || j == alone ? 1 : 2) * cells[row + j];
  Psf psf;
  psf.size = grid.size;
  psf.spacing_um = grid.spacing_um;
  psf.captured = total * std::pow(grid.sample_spacing_um() * mm_per_um * sum.waves_per_mm, 2) / pupil.flux;
  const auto size = static_cast<std::size_t>(grid.size);
  psf.values.resize(size * size, 0.0F);
  const int middle = grid.size / 2, right = std::min(lit.reach, grid.size - 1 - middle);
  for (int i = 0; i < lit.rows; ++i) {
    const double* from = &cells[static_cast<std::size_t>(i) * columns];
    float* to =
        &psf.values[static_cast<std::size_t>(lit.first_row + i) * size + static_cast<std::size_t>(middle)];
    for (int j = 0; j <= lit.reach; ++j) to[-j] = static_cast<float>(from[j] / total);
    std::reverse_copy(to - right, to, to + 1);
  }
  return psf;
}

}  // namespace petzval
