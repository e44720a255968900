// SPDX-License-Identifier: BSD-3-Clause
// Sums of short convolutions of rows, on whatever SIMD the machine has: lanes are neighbouring cells.
#pragma once

#include <cstddef>
#include <span>

namespace petzval {

/// A row of light with the weights by which it spreads. Light must be readable, and zero where there is
/// none, from 2 · radius before light[0] to row_padding() behind the last sum.
struct RowTerm {
  const float* light;
  const float* weights;  ///< 2 · radius + 1, from the left
};

/// sums[c] = Σ_terms Σ_k weights[k] · light[c − k] for c from 0 to count: the sums begin one radius left of
/// the light. Sums must have room for row_padding() more.
void convolve_rows(std::span<const RowTerm> terms, int radius, std::size_t count, float* sums);

/// Floats that a row is read, or written, beyond its end.
std::size_t row_padding();

}  // namespace petzval
