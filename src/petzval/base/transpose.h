// SPDX-License-Identifier: BSD-3-Clause
// Rows into columns.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace petzval {

/// A matrix within a larger one, row by row: from the beginning of a row to that of the next are `step`
/// values.
template <class Value>
struct MatrixPart {
  Value* values;
  std::size_t step;
};

/// to[j][i] = from[i][j] for i < rows, j < columns.
///
/// By squares whose rows fill a cache line on either side, put together aside: rows that lie a power of two
/// apart share few places in the cache. Quickest where `from` or `to` holds some hundred columns or rows.
template <class Value>
void transpose(MatrixPart<const Value> from, std::size_t rows, std::size_t columns, MatrixPart<Value> to) {
  constexpr std::size_t side = 64 / sizeof(Value);
  std::array<std::array<Value, side>, side> square;
  for (std::size_t i = 0; i < rows; i += side)
    for (std::size_t j = 0; j < columns; j += side) {
      const Value* in = from.values + i * from.step + j;
      Value* out = to.values + j * to.step + i;
      const std::size_t high = std::min(side, rows - i), wide = std::min(side, columns - j);
      if (high == side && wide == side) {
        for (std::size_t a = 0; a < side; ++a)
          for (std::size_t b = 0; b < side; ++b) square[b][a] = in[a * from.step + b];
        for (std::size_t b = 0; b < side; ++b) std::copy_n(square[b].data(), side, out + b * to.step);
      } else {
        for (std::size_t b = 0; b < wide; ++b)
          for (std::size_t a = 0; a < high; ++a) out[b * to.step + a] = in[a * from.step + b];
      }
    }
}

}  // namespace petzval
