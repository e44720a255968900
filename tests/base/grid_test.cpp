// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/grid.h>

namespace petzval {
namespace {

TEST(Grid, LiesRowByRow) {
  Grid<int> grid(2, 3, std::vector<int>{1, 2, 3, 4, 5, 6});
  EXPECT_EQ(grid.at(0, 2), 3);
  EXPECT_EQ(grid.at(1, 0), 4);
  grid.row(1)[2] = 7;
  EXPECT_EQ(grid.values().back(), 7);
  EXPECT_EQ(grid.row(0).size(), 3U);
}

TEST(Grid, BeginsWithOneValue) {
  const Grid<double> grid(4, 5, 0.5);
  EXPECT_EQ(grid.size(), 20U);
  EXPECT_EQ(grid.at(3, 4), 0.5);
  EXPECT_TRUE(Grid<float>().empty());
}

TEST(Grid, RefusesOtherNumbersOfValues) {
  EXPECT_THROW(Grid<int>(2, 3, std::vector<int>(5)), InputError);
  EXPECT_THROW(Grid<int>(-1, -3, 0), InputError);
  EXPECT_THROW(Grid<int>(-1, -3, std::vector<int>(3)), InputError);
}

}  // namespace
}  // namespace petzval
