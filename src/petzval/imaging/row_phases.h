// SPDX-License-Identifier: BSD-3-Clause
// Rows of which every n-th value belongs together.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace petzval {

/// Puts each `step`th value of a row side by side: phases[p][i] = row[i · step + p], all as long, the last
/// ones filled with zeros. So sums of every step-th value run along rows, which vectors do at full width.
inline void sort_out_phases(std::span<const float> row, std::size_t step, std::vector<float>& phases) {
  const std::size_t length = (row.size() + step - 1) / step, whole = row.size() / step;
  phases.assign(step * length, 0.0F);
  for (std::size_t phase = 0; phase < step; ++phase) {
    float* const to = phases.data() + phase * length;
    for (std::size_t i = 0; i < whole; ++i) to[i] = row[i * step + phase];
    if (whole < length && whole * step + phase < row.size()) to[whole] = row[whole * step + phase];
  }
}

}  // namespace petzval
