// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/numeric/root.h>

#include <cmath>

namespace petzval {
namespace {

TEST(LastAboveZero, FindsTheZerosOfKnownFunctions) {
  EXPECT_NEAR(last_above_zero(0, 3, [](double x) { return 2 - x * x; }), std::sqrt(2.0), 1e-13);
  EXPECT_NEAR(last_above_zero(1, -2, [](double x) { return std::exp(x) - 0.5; }), std::log(0.5), 1e-13);
  EXPECT_NEAR(last_above_zero(0, 1, [](double x) { return std::pow(0.3 - x, 3); }), 0.3, 1e-4);
}

TEST(LastAboveZero, StopsBeforeAStep) {
  const double at = last_above_zero(0, 1, [](double x) { return x < 0.7 ? 1.0 : -5.0; });
  EXPECT_LE(at, 0.7);
  EXPECT_NEAR(at, 0.7, 1e-12);
}

TEST(LastAboveZero, IsTheOutsideWhereNothingComesDown) {
  EXPECT_EQ(last_above_zero(0, 4, [](double x) { return 1 + x; }), 4);
}

}  // namespace
}  // namespace petzval
