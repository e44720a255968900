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

  std::vector<double> beta, half_chord;  ///< one a chord
  std::vector<float> strength;           ///< twice its weight and half chord
  std::size_t terms = 0;
  std::vector<double> phase;     ///< terms × chords: Chebyshev series in 2(α/alpha_scale)² − 1
  std::vector<float> amplitude;  ///< the same
  double alpha_scale = 1;
  std::vector<QuadratureRule> along;           ///< on [0, 1], for the half chords of each chords_together
  double waves_per_mm = 0;                     ///< n'/λ
  double column_step_mm = 0, row_step_mm = 0;  ///< between samples, along s and t
  double first_column_mm = 0, first_row_mm = 0;
  int columns = 0, rows = 0;
};

/// Samples of U, column by column. Before and after the rows of each there is room for a vector of them.
class WaveSamples {
 public:
  static constexpr std::size_t margin = 16;

  WaveSamples(int columns, int rows);
  /// The first row of a column.
  float* re(std::size_t column) { return &values_[2 * column * stride_ + margin]; }
  float* im(std::size_t column) { return re(column) + stride_; }
  const float* re(std::size_t column) const { return &values_[2 * column * stride_ + margin]; }
  const float* im(std::size_t column) const { return re(column) + stride_; }

 private:
  std::size_t stride_;
  std::vector<float> values_;
};

/// Phases in double, sums in single precision: the error of U is about 1e-7 Σ|g|.
WaveSamples sum_chord_waves(const ChordSum& sum);

}  // namespace petzval
