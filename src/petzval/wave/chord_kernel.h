// SPDX-License-Identifier: BSD-3-Clause
// The inner loops of the plane-wave sum over the chords of a pupil, on whatever SIMD the machine has.
#pragma once

#include <petzval/numeric/quadrature.h>

#include <cstddef>
#include <vector>

namespace petzval {

/// U(s, t) = Σ_i weight_i e^{ikβ_i t} F_i(s), F_i(s) = Σ_j g_ij 2cos(kα_ij s): chords i of constant β, nodes
/// j along half of each. All lengths in mm.
struct ChordSum {
  /// Chords that share a rule of nodes. Their number is a multiple of it; chords of weight 0 fill the last.
  static constexpr std::size_t chords_together = 16;

  std::vector<double> beta, weight, half_chord;  ///< one a chord
  std::size_t terms = 0;
  std::vector<double> phase, amplitude;  ///< terms × chords: Chebyshev series in 2(α/alpha_scale)² − 1
  double alpha_scale = 1;
  std::vector<QuadratureRule> along;  ///< on [0, 1], for the half chords of each chords_together
  double waves_per_mm = 0;            ///< n'/λ
  double step_mm = 0;                 ///< between samples, along s and t
  double first_column_mm = 0, first_row_mm = 0;
  int columns = 0, rows = 0;
  int cell = 1;  ///< samples a side of a cell; divides rows and columns
};

/// cells[i·columns/cell + j] = Σ |U|² over the samples of each cell. Turns in double, sums in single
/// precision: the error of U is about 1e-7 Σ|g|.
void sum_chord_cells(const ChordSum& sum, std::vector<double>& cells);

}  // namespace petzval
