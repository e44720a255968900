// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/imaging/field_mixture.h>

#include <cmath>
#include <functional>
#include <vector>

namespace petzval {
namespace {

const std::vector<double> heights{0, 0.9, 2.1, 2.8, 4.0};

/// Values of an even or odd function at the fields, mixed.
double mixed(const std::vector<double>& height, double at, const std::function<double(double)>& of,
             bool odd = false) {
  double sum = 0;
  for (const FieldShare& share : field_shares(height, at))
    sum += share.weight * of(height[share.field]) * (share.across_axis && odd ? -1 : 1);
  return sum;
}

TEST(FieldMixture, WeightsSumToOneAndMeetTheFields) {
  for (double at = -0.5; at < 4.5; at += 0.01)
    EXPECT_NEAR(mixed(heights, at, [](double) { return 1.0; }), 1, 1e-14);
  for (const double height : heights)
    EXPECT_NEAR(mixed(heights, height, [](double h) { return std::cos(3 * h); }), std::cos(3 * height),
                1e-14);
}

TEST(FieldMixture, FollowsParabolas) {
  for (double at = 0; at <= 4; at += 0.01) {
    EXPECT_NEAR(mixed(
                    heights, at, [](double h) { return h; }, true),
                at, 1e-13)
        << at;
    EXPECT_NEAR(mixed(heights, at, [](double h) { return h * h; }), at * at, 1e-13) << at;
    EXPECT_NEAR(mixed({1, 2, 4}, 1 + at / 2, [](double h) { return h * h; }), std::pow(1 + at / 2, 2), 1e-13)
        << at;
  }
}

TEST(FieldMixture, HasNoBendAtFields) {
  const auto curve = [](double at) { return mixed(heights, at, [](double h) { return std::cos(2 * h); }); };
  constexpr double step = 1e-5;
  for (std::size_t i = 1; i + 1 < heights.size(); ++i) {
    const double left = (curve(heights[i]) - curve(heights[i] - step)) / step,
                 right = (curve(heights[i] + step) - curve(heights[i])) / step;
    EXPECT_NEAR(left, right, 40 * step) << heights[i];  // the second derivative is about 10
  }
  EXPECT_NEAR((curve(step) - curve(0)) / step, 0, 40 * step);  // even functions are flat on the axis
}

TEST(FieldMixture, TwoFieldsAwayFromTheAxisAreMixedLinearly) {
  EXPECT_NEAR(mixed({1, 3}, 1.5, [](double h) { return h; }), 1.5, 1e-14);
  EXPECT_NEAR(mixed({1, 3}, 1.5, [](double h) { return h * h; }), 0.75 * 1 + 0.25 * 9, 1e-14);
}

TEST(FieldMixture, OuterWeightsAreSmall) {
  double least = 0;
  for (double at = 1; at < 2; at += 0.001)
    for (const FieldShare& share : field_shares(std::vector<double>{0, 1, 2, 3}, at))
      least = std::min(least, share.weight);
  EXPECT_NEAR(least, -2.0 / 27, 1e-6);
}

TEST(FieldMixture, HoldsTheEnds) {
  EXPECT_EQ(mixed(heights, 9, [](double h) { return h; }), 4);
  EXPECT_EQ(mixed({1, 2, 3}, 0.2, [](double h) { return h; }), 1);
  EXPECT_EQ(mixed({2}, 5, [](double h) { return h; }), 2);
}

}  // namespace
}  // namespace petzval
