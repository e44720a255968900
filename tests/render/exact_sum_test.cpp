// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/render/film/exact_sum.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace petzval::render {
namespace {

TEST(ExactSum, DoesNotDependOnTheOrder) {
  std::mt19937 random(7);
  std::vector<double> values;
  for (int i = 0; i < 2000; ++i)
    values.push_back(
        std::ldexp(std::uniform_real_distribution(-1.0, 1.0)(random), static_cast<int>(random() % 80) - 55));
  ExactSum forwards;
  for (const double value : values) forwards += value;
  // Sums of doubles differ: the values span 80 powers of two.
  double one = 0, other = 0;
  for (const double value : values) one += value;
  for (auto at = values.rbegin(); at != values.rend(); ++at) other += *at;
  EXPECT_NE(one, other);
  for (int i = 0; i < 5; ++i) {
    std::shuffle(values.begin(), values.end(), random);
    ExactSum first, second;
    for (std::size_t k = 0; k < values.size(); ++k) (k % 3 ? first : second) += values[k];
    first += second;
    EXPECT_EQ(first, forwards);
  }
}

TEST(ExactSum, IsRightToADouble) {
  // Whole multiples of 2^-60 whose sum long double holds exactly.
  std::mt19937 random(8);
  ExactSum sum;
  long double exact = 0;
  for (int i = 0; i < 1000; ++i) {
    const double value = std::ldexp(static_cast<double>(random() % 1000000), -60);
    sum += value, exact += static_cast<long double>(value);
  }
  EXPECT_EQ(sum.value(), static_cast<double>(exact));
}

/// One value alone is what truncation to a multiple of 2^-72 makes of it.
TEST(ExactSum, CutsWhatIsFinerThanItsUnits) {
  std::mt19937_64 random(9);
  std::vector<double> values{0,
                             1,
                             -1,
                             0x1p-72,
                             0x1p-73,
                             -0x1.8p-72,
                             0x1.fffffffffffffp-20,
                             0x1p-1074,
                             0x1.fffffffffffffp29,
                             -0x1.fffffffffffffp29};
  for (int i = 0; i < 2000; ++i)
    values.push_back(std::ldexp(std::uniform_real_distribution(-1.0, 1.0)(random),
                                static_cast<int>(random() % 160) - 130));
  for (const double value : values) {
    ExactSum sum;
    sum += value;
    EXPECT_EQ(sum.value(), std::ldexp(std::trunc(std::ldexp(value, 72)), -72)) << value;
  }
}

TEST(ExactSum, HoldsTheMostOfTheMostSamplesAndNothingOfWhatIsNoNumber) {
  ExactSum sum;
  for (int i = 0; i < 1 << 24; ++i) sum += std::numeric_limits<double>::infinity();
  sum += std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(sum.value(), std::ldexp(1.0, 54));
}

}  // namespace
}  // namespace petzval::render
