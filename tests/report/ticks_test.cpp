// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/report/ticks.h>

#include <cmath>
#include <limits>
#include <random>

namespace petzval {
namespace {

/// The number that a label shows: a true minus read as '-'.
double read_label(std::string label) {
  if (label.rfind("\xE2\x88\x92", 0) == 0) label.replace(0, 3, "-");
  return std::stod(label);
}

void expect_sound(const Ticks& ticks) {
  ASSERT_LT(ticks.from, ticks.to);
  ASSERT_TRUE(std::isfinite(ticks.from) && std::isfinite(ticks.to));
  ASSERT_EQ(ticks.values.size(), ticks.labels.size());
  for (std::size_t i = 0; i < ticks.values.size(); ++i) {
    EXPECT_GE(ticks.values[i], ticks.from);
    EXPECT_LE(ticks.values[i], ticks.to);
    EXPECT_FALSE(ticks.labels[i].empty());
    if (i > 0) {
      EXPECT_GT(ticks.values[i], ticks.values[i - 1]);
      EXPECT_NE(ticks.labels[i], ticks.labels[i - 1]);
    }
  }
}

TEST(LinearTicks, OfKnownRanges) {
  const Ticks ticks = make_ticks(PlotScale::linear, 0, 2.75, 7, true);
  EXPECT_EQ(ticks.labels, (std::vector<std::string>{"0.0", "0.5", "1.0", "1.5", "2.0", "2.5", "3.0"}));
  EXPECT_EQ(ticks.to, 3);
  EXPECT_EQ(make_ticks(PlotScale::linear, -10.67, 0, 5, true).labels.front(),
            "\xE2\x88\x92"
            "15");
  EXPECT_EQ(make_ticks(PlotScale::linear, 0, 2.75, 7, false).to, 2.75);
}

// Any range: ticks lie in it at a step of 1, 2 or 5 times a power of ten, about as many as asked for; growing
// outwards covers the range and ends on ticks; the labels say the values.
TEST(LinearTicks, HoldTheirPromisesForAnyRange) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> exponent(-12, 12), mantissa(-1, 1);
  for (int round = 0; round < 2000; ++round) {
    const double centre = mantissa(random) * std::pow(10, exponent(random));
    const double width = (0.01 + std::abs(centre)) * std::pow(10, mantissa(random) * 3);
    const Ticks ticks = make_ticks(PlotScale::linear, centre, centre + width, 6, true);
    expect_sound(ticks);
    EXPECT_LE(ticks.from, centre);
    EXPECT_GE(ticks.to, centre + width);
    ASSERT_GE(ticks.values.size(), 3u);
    EXPECT_LE(ticks.values.size(), 9u);
    // A range that ends within a millionth of a step beside a tick is taken to end on it.
    const double step = ticks.values[1] - ticks.values[0];
    EXPECT_NEAR(ticks.values.front(), ticks.from, 1.01e-6 * step);
    EXPECT_NEAR(ticks.values.back(), ticks.to, 1.01e-6 * step);
    const double lead = step / std::pow(10, std::floor(std::log10(step) + 1e-6));
    EXPECT_LT(std::min({std::abs(lead - 1), std::abs(lead - 2), std::abs(lead - 5)}), 1e-3) << step;
    for (std::size_t i = 0; i < ticks.values.size(); ++i)
      EXPECT_NEAR(read_label(ticks.labels[i]) * std::pow(10, ticks.exponent), ticks.values[i], 1e-3 * step);
  }
}

TEST(LinearTicks, ServeEveryRange) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::nan("");
  for (const double from : {0.0, 5.0, -1e300, 1e308, -inf, inf, nan, 1e-320})
    for (const double to : {0.0, 5.0, 5.0 + 1e-15, 1e308, -inf, inf, nan})
      for (const bool outwards : {true, false})
        for (const PlotScale scale : {PlotScale::linear, PlotScale::logarithmic})
          expect_sound(make_ticks(scale, from, to, 5, outwards));
}

TEST(LogarithmicTicks, StandAtPowersOfTen) {
  const Ticks many = make_ticks(PlotScale::logarithmic, 2e-6, 1, 7, true);
  EXPECT_EQ(many.labels, (std::vector<std::string>{"10⁻⁶", "10⁻⁵", "10⁻⁴", "0.001", "0.01", "0.1", "1"}));
  EXPECT_DOUBLE_EQ(many.from, 1e-6);
  const Ticks few = make_ticks(PlotScale::logarithmic, 1, 40, 7, true);
  EXPECT_EQ(few.labels, (std::vector<std::string>{"1", "2", "5", "10", "20", "50", "100"}));
  EXPECT_EQ(few.minor.size(), 12u);  // 3 4 6 7 8 9 and ten times that
}

TEST(Numbers, NiceLengths) {
  EXPECT_DOUBLE_EQ(nice_length(1), 1);
  EXPECT_DOUBLE_EQ(nice_length(4.99), 2);
  EXPECT_DOUBLE_EQ(nice_length(5), 5);
  EXPECT_DOUBLE_EQ(nice_length(0.00099), 0.0005);
}

TEST(Numbers, ShortTexts) {
  EXPECT_EQ(short_number(0.5), "0.5");
  EXPECT_EQ(short_number(-2.25, 2),
            "\xE2\x88\x92"
            "2.2");
  EXPECT_EQ(short_number(-0.0), "0");
  EXPECT_EQ(short_number(std::nan("")), "–");
  EXPECT_EQ(power_of_ten(-12), "10⁻¹²");
}

}  // namespace
}  // namespace petzval
