// SPDX-License-Identifier: BSD-3-Clause
// Weighted sums down and along rows of cells, on whatever SIMD the machine has.
#pragma once

#include <cstddef>
#include <span>

namespace petzval {

/// sums[j] = Σ_i weights[i] · cells[i · stride + j] for j from 0 to sums.size().
void sum_down(const float* cells, std::size_t stride, std::span<const float> weights, std::span<float> sums);

/// sums[c] += Σ_k weights[k] · row[step · c + k], of a row sorted by sort_out_phases() with that step.
void add_along(std::span<const float> phases, std::size_t step, std::span<const float> weights,
               std::span<float> sums);

}  // namespace petzval
