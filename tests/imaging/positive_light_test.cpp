// SPDX-License-Identifier: BSD-3-Clause
#include "imaging/synthetic_table.h"

#include <gtest/gtest.h>
#include <petzval/imaging/positive_light.h>

#include <algorithm>
#include <random>

namespace petzval {
namespace {

using namespace testing;

TEST(PositiveLight, LeavesNothingBelowZeroAndKeepsTheSum) {
  std::mt19937 random(1846);
  std::normal_distribution<float> around(0.05F, 1);
  for (const auto& [columns, rows] : {std::pair{64, 64}, {61, 37}, {1, 9}, {300, 2}}) {
    CellPlane plane({columns, rows, 5});
    for (float& value : plane.values) value = around(random);
    plane.values[0] += 5 * static_cast<float>(plane.values.size());  // light enough in all
    const double before = sum_of(plane);
    const CellPlane after = without_negative_light(plane);
    EXPECT_GE(*std::min_element(after.values.begin(), after.values.end()), 0);
    EXPECT_NEAR(sum_of(after) / before, 1, 1e-6) << columns << " x " << rows;
  }
}

TEST(PositiveLight, IsPaidByTheNearest) {
  CellPlane plane({8, 8, 5});
  std::fill(plane.values.begin(), plane.values.end(), 2.0F);
  plane.row(2)[3] = -1;
  const CellPlane after = without_negative_light(plane);
  for (std::size_t row = 0; row < 8; ++row)
    for (std::size_t column = 0; column < 8; ++column) {
      const bool in_square = row / 2 == 1 && column / 2 == 1, itself = row == 2 && column == 3;
      EXPECT_FLOAT_EQ(after.row(row)[column], itself ? 0.0F : in_square ? 2 * 5.0F / 6 : 2.0F);
    }
}

TEST(PositiveLight, LeavesLightAsItIs) {
  const CellPlane plane = random_plane({33, 21, 5});
  EXPECT_EQ(without_negative_light(plane).values, plane.values);
  CellPlane dark({5, 5, 5});
  dark.row(2)[2] = -1;
  const CellPlane after = without_negative_light(dark);
  EXPECT_EQ(*std::max_element(after.values.begin(), after.values.end()), 0);
  EXPECT_EQ(*std::min_element(after.values.begin(), after.values.end()), 0);
}

}  // namespace
}  // namespace petzval
