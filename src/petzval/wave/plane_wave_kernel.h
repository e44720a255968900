// SPDX-License-Identifier: BSD-3-Clause
// The inner loops of the plane-wave sum, on whatever SIMD the machine has.
#pragma once

#include <vector>

namespace petzval {

/// What each node brings along: its wave at the first row, and the turns from one row (t) and column (s) to
/// the next.
struct WaveTurns {
  std::vector<double> start_re, start_im;    ///< amplitude · e^{i…} at the first row
  std::vector<double> row_re, row_im;        ///< unit
  std::vector<double> column_re, column_im;  ///< unit

  void resize(std::size_t count);
};

enum class WaveColumns { cosines, sines };

/// field[i·columns + c] = Σ_j start_j · row_j^i · 2 Re(column_j^c), or Im for sines, i < rows, c < columns: a
/// rows × nodes matrix of complex numbers times a nodes × columns matrix of real ones, both made on the way,
/// in single precision with rotations in double. Error about 1e-7 of the largest value.
void sum_wave_turns(const WaveTurns& turns, WaveColumns kind, int rows, int columns,
                    std::vector<double>& field_re, std::vector<double>& field_im);

}  // namespace petzval
