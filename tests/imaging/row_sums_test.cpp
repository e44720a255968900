// SPDX-License-Identifier: BSD-3-Clause
// Weighted sums of rows against sums written out.
#include <gtest/gtest.h>
#include <petzval/imaging/row_phases.h>
#include <petzval/imaging/row_sums.h>

#include <random>

namespace petzval {
namespace {

std::vector<float> random_row(std::size_t count) {
  std::mt19937 generator(static_cast<unsigned>(count));
  std::uniform_real_distribution<float> between(-1, 1);
  std::vector<float> row(count);
  for (float& value : row) value = between(generator);
  return row;
}

TEST(RowPhases, PutEveryNthValueSideBySide) {
  const std::vector<float> row{0, 1, 2, 3, 4, 5, 6};
  std::vector<float> phases;
  sort_out_phases(row, 1, phases);
  EXPECT_EQ(phases, row);
  sort_out_phases(row, 3, phases);
  EXPECT_EQ(phases, (std::vector<float>{0, 3, 6, 1, 4, 0, 2, 5, 0}));
}

// Lengths that fill vectors and lengths that do not; steps as many as cells along a pixel.
TEST(RowSums, AreThoseWrittenOut) {
  constexpr float rounding = 1e-5F;  // of nine products of at most one
  constexpr std::size_t size = 9;
  const std::vector<float> weights = random_row(size);
  for (const std::size_t count : {1U, 7U, 64U, 150U}) {
    const std::size_t stride = count + 3;
    const std::vector<float> cells = random_row(size * stride);
    std::vector<float> sums(count, 5);
    sum_down(cells.data(), stride, weights, sums);
    for (std::size_t j = 0; j < count; ++j) {
      float expected = 0;
      for (std::size_t i = 0; i < size; ++i) expected += weights[i] * cells[i * stride + j];
      EXPECT_NEAR(sums[j], expected, rounding) << count << " " << j;
    }
    for (const std::size_t step : {1U, 2U, 3U, 5U}) {
      const std::vector<float> row = random_row((count - 1) * step + size);
      std::vector<float> phases;
      sort_out_phases(row, step, phases);
      std::vector<float> added(count, 2);
      add_along(phases, step, weights, added);
      for (std::size_t c = 0; c < count; ++c) {
        float expected = 2;
        for (std::size_t k = 0; k < size; ++k) expected += weights[k] * row[c * step + k];
        EXPECT_NEAR(added[c], expected, rounding) << count << " " << step << " " << c;
      }
    }
  }
}

}  // namespace
}  // namespace petzval
