// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/numeric/quadrature.h>
#include <petzval/wave/chord_kernel.h>
#include <petzval/wave/chord_sum.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace petzval {

namespace {

constexpr int most_samples = 1 << 14;
/// A panel carries phases up to ± this [rad], with nodes for twice its polynomial degree.
constexpr double panel_phase = 120;
constexpr int least_panels = 2;

/// Gauss-Legendre panels on [from, to] that integrate e^{iBx} of ±`phase` rad to rounding: a panel of ±b rad
/// needs polynomials of degree b + O(b^⅓), of which n nodes take 2n − 1.
QuadratureRule panels(double from, double to, double phase) {
  const int count = std::max(least_panels, static_cast<int>(std::ceil(phase / panel_phase)));
  const double each = phase / count;
  const QuadratureRule unit =
      gauss_legendre(static_cast<int>(std::ceil(0.5 * (each + 6 * std::cbrt(each))) + 10));
  QuadratureRule rule;
  const double width = (to - from) / count;
  for (int p = 0; p < count; ++p)
    for (std::size_t j = 0; j < unit.nodes.size(); ++j) {
      rule.nodes.push_back(from + (p + unit.nodes[j]) * width);
      rule.weights.push_back(unit.weights[j] * width);
    }
  return rule;
}

void add_chords(const SmoothPupil& pupil, const QuadratureRule& betas, ChordSum& sum) {
  sum.terms = pupil.phase_waves.terms();
  sum.alpha_scale = pupil.phase_waves.x_scale();
  std::vector<double> series(sum.terms);
  for (std::size_t i = 0; i < betas.nodes.size(); ++i) {
    const double half = pupil.half_chord(betas.nodes[i]);
    if (!(half > 0)) continue;
    sum.beta.push_back(betas.nodes[i]);
    sum.weight.push_back(betas.weights[i]);
    sum.half_chord.push_back(half);
    pupil.phase_waves.series(betas.nodes[i], series);
    sum.phase.insert(sum.phase.end(), series.begin(), series.end());
    pupil.amplitude.series(betas.nodes[i], series);
    sum.amplitude.insert(sum.amplitude.end(), series.begin(), series.end());
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
ChordSum chord_sum(const SmoothPupil& pupil, const PsfGrid& grid, const Lit& lit) {
  const double spacing_mm = grid.spacing_um * mm_per_um;
  ChordSum sum;
  sum.waves_per_mm = pupil.image_index / (pupil.wavelength_nm * mm_per_nm);
  sum.cell = grid.samples_per_cell;
  sum.step_mm = spacing_mm / sum.cell;
  sum.rows = lit.rows * sum.cell;
  sum.columns = (lit.reach + 1) * sum.cell;
  const double first_of_cell_mm = -0.5 * (sum.cell - 1) * sum.step_mm;
  sum.first_column_mm = first_of_cell_mm;
  sum.first_row_mm = first_of_cell_mm + (lit.first_row - grid.size / 2) * spacing_mm;
  // The waves' phase turns as fast as the farthest ray is from the farthest sample.
  const double k = 2 * pi * sum.waves_per_mm;
  const double low_mm = (lit.first_row - grid.size / 2 - 1) * spacing_mm;
  const double high_mm = low_mm + (lit.rows + 1) * spacing_mm;
  const double distance_t = std::max(high_mm - pupil.low_t_mm, pupil.high_t_mm - low_mm);
  const double distance_s = (lit.reach + 1) * spacing_mm + pupil.reach_s_mm;
  const QuadratureRule along = panels(0, 1, 0.5 * k * pupil.alpha_max() * distance_s);
  sum.node = along.nodes;
  sum.node_weight = along.weights;
  const std::vector<double> ends = smooth_intervals(pupil);
  for (std::size_t i = 0; i + 1 < ends.size(); ++i)
    add_chords(pupil, panels(ends[i], ends[i + 1], 0.5 * k * (ends[i + 1] - ends[i]) * distance_t), sum);
  return sum;
}

}  // namespace

Psf sum_chords(const SmoothPupil& pupil, const PsfGrid& grid) {
  if (grid.size < 1 || !(grid.spacing_um > 0) || grid.samples_per_cell < 1 ||
      grid.size > most_samples / grid.samples_per_cell)
    throw InputError(fmt::format("a PSF needs at least one sample, at most {} a side, and a positive spacing",
                                 most_samples));
  const Lit lit(grid);
  const ChordSum sum = chord_sum(pupil, grid, lit);
  std::vector<double> cells;
  sum_chord_cells(sum, cells);

  const auto columns = static_cast<std::size_t>(lit.reach + 1);
  double total = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) total += (i % columns == 0 ? 1 : 2) * cells[i];
  // The first column of an even size has no partner on the right.
  if (grid.size % 2 == 0 && lit.reach == grid.size / 2)
    for (std::size_t i = columns - 1; i < cells.size(); i += columns) total -= cells[i];
  Psf psf;
  psf.size = grid.size;
  psf.spacing_um = grid.spacing_um;
  psf.captured = total * std::pow(sum.step_mm * sum.waves_per_mm, 2) / pupil.flux;
  const auto size = static_cast<std::size_t>(grid.size);
  psf.values.resize(size * size, 0.0F);
  for (int i = 0; i < lit.rows; ++i)
    for (int j = 0; j < grid.size; ++j)
      if (const int column = std::abs(j - grid.size / 2); column <= lit.reach)
        psf.values[static_cast<std::size_t>(lit.first_row + i) * size + static_cast<std::size_t>(j)] =
            static_cast<float>(
                cells[static_cast<std::size_t>(i) * columns + static_cast<std::size_t>(column)] / total);
  return psf;
}

}  // namespace petzval
