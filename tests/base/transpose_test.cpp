// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/transpose.h>

#include <numeric>
#include <vector>

namespace petzval {
namespace {

/// A part of a matrix of `step` columns into a part of another; what lies around it must stay.
template <class Value>
void expect_turned(std::size_t rows, std::size_t columns) {
  const std::size_t step = columns + 3, to_step = rows + 5;
  std::vector<Value> from(rows * step), to(columns * to_step, Value{-1});
  std::iota(from.begin(), from.end(), Value{1});
  transpose<Value>({from.data(), step}, rows, columns, {to.data(), to_step});
  for (std::size_t j = 0; j < columns; ++j)
    for (std::size_t i = 0; i < to_step; ++i)
      ASSERT_EQ(to[j * to_step + i], i < rows ? from[i * step + j] : Value{-1}) << i << ", " << j;
}

TEST(Transpose, TurnsPartsOfAnySize) {
  for (const std::size_t rows : {0U, 1U, 7U, 16U, 33U, 48U})
    for (const std::size_t columns : {0U, 1U, 8U, 16U, 31U, 64U}) {
      expect_turned<float>(rows, columns);
      expect_turned<double>(rows, columns);
    }
}

}  // namespace
}  // namespace petzval
