// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/glass/dispersion.h>
#include <petzval/numeric/interpolation.h>

#include <cmath>
#include <limits>
#include <vector>

namespace petzval {
namespace {

/// A few rounding errors of numbers near 1.
constexpr double rounding = 1e-15;

double formula(int number, std::vector<double> coefficients, double nm) {
  return dispersion_formula(number, coefficients, nm);
}

// At 2 µm every term is a number that can be worked out by hand.
TEST(DispersionFormula, SellmeierTermsByHand) {
  // n² = 1 + 0.25 + 1·4/(4 − 2) + 0.5·4/(4 − 3) = 5.25
  EXPECT_NEAR(formula(2, {0.25, 1, 2, 0.5, 3}, 2000), std::sqrt(5.25), 3 * rounding);
  EXPECT_NEAR(formula(1, {0.25, 1, std::sqrt(2), 0.5, std::sqrt(3)}, 2000), std::sqrt(5.25), 10 * rounding);
}

TEST(DispersionFormula, PowersByHand) {
  // 2 + 0.1·2² + 0.8·2⁻² + 1.6·2⁻⁴ = 2.7
  const std::vector<double> coefficients = {2, 0.1, 2, 0.8, -2, 1.6, -4};
  EXPECT_NEAR(formula(3, coefficients, 2000), std::sqrt(2.7), 3 * rounding);
  EXPECT_NEAR(formula(5, coefficients, 2000), 2.7, 3 * rounding);
}

TEST(DispersionFormula, RefusesWhatHasNoIndex) {
  EXPECT_THROW(formula(2, {0, 1, 4}, 2000), InputError) << "on the resonance";
  EXPECT_THROW(formula(3, {-2}, 500), InputError) << "negative n²";
  EXPECT_THROW(formula(5, {0}, 500), InputError) << "n = 0";
  EXPECT_THROW(formula(10, {1}, 500), InputError) << "unknown formula";
  EXPECT_THROW(formula(0, {1}, 500), InputError);
  EXPECT_THROW(formula(4, std::vector<double>(18, 1), 500), InputError) << "too many coefficients";
  EXPECT_THROW(formula(2, {}, 500), InputError);
  EXPECT_THROW(formula(2, {0, 1}, 500), InputError) << "half a pair";
  for (const double nm : {0.0, -500.0, std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_THROW(formula(5, {1.5}, nm), InputError) << nm;
}

const std::vector<std::pair<double, double>> five_entries = {
    {404.66, 1.5302}, {486.13, 1.5224}, {546.07, 1.5187}, {587.56, 1.5168}, {656.27, 1.5143}};

TEST(TabulatedIndex, IsExactAtTheEntries) {
  for (const auto& [nm, n] : five_entries) EXPECT_EQ(tabulated_index(five_entries, nm), n) << nm;
}

TEST(TabulatedIndex, FallsMonotonically) {
  double before = 2;
  for (double nm = 404.66; nm <= 656.27; nm += 0.5) {
    const double n = tabulated_index(five_entries, nm);
    EXPECT_LT(n, before) << nm;
    before = n;
  }
}

// A smooth dispersion curve sampled every 10 nm: a cubic leaves h⁴/384·max|n''''| ≈ 3e-8 at 410 nm in its
// interior and several times that at the ends, where the slopes are one-sided.
TEST(TabulatedIndex, FollowsASmoothCurve) {
  const auto cauchy = [](double nm) { return 1.5 + 0.004 / (nm * nm * 1e-6); };
  std::vector<std::pair<double, double>> table;
  for (double nm = 400; nm <= 700; nm += 10) table.emplace_back(nm, cauchy(nm));
  for (double nm = 400; nm <= 700; nm += 0.7) EXPECT_NEAR(tabulated_index(table, nm), cauchy(nm), 5e-7) << nm;
}

// Only a few neighbours are looked at; the curve must be that through all entries.
TEST(TabulatedIndex, OfALongTableIsTheCurveThroughAllOfIt) {
  std::vector<std::pair<double, double>> table;
  std::vector<double> wavelengths, indices;
  for (int i = 0; i < 60; ++i) {
    wavelengths.push_back(400 + 5 * i + 2 * std::sin(i));
    indices.push_back(1.6 - 0.001 * i + 0.0007 * std::sin(1.7 * i));
    table.emplace_back(wavelengths.back(), indices.back());
  }
  const MonotoneCubic whole(wavelengths, indices);
  for (double nm = wavelengths.front(); nm < wavelengths.back(); nm += 0.37)
    EXPECT_NEAR(tabulated_index(table, nm), whole(nm), rounding) << nm;
}

TEST(TabulatedIndex, EndsWhereTheTableEnds) {
  EXPECT_THROW(tabulated_index(five_entries, 404.65), InputError);
  EXPECT_THROW(tabulated_index(five_entries, 656.28), InputError);
  EXPECT_THROW(tabulated_index(five_entries, std::nan("")), InputError);
  const std::vector<std::pair<double, double>> one = {{587.5618, 1.5168}};
  EXPECT_EQ(tabulated_index(one, 587.5618), 1.5168);
  EXPECT_EQ(tabulated_index(one, 587.5618 + 5e-7), 1.5168);
  EXPECT_THROW(tabulated_index(one, 587.5618 + 2e-6), InputError);
  EXPECT_THROW(tabulated_index(one, 587.5618 - 2e-6), InputError);
}

TEST(AbbeNumbers, FollowTheDefinition) {
  // n = 1.5 + 0.001·(1000/λ): n_F − n_C by hand.
  const auto index = [](double nm) { return 1.5 + 1 / nm; };
  const AbbeNumbers numbers = abbe_numbers(index);
  EXPECT_DOUBLE_EQ(numbers.nd, 1.5 + 1 / 587.5618);
  EXPECT_NEAR(numbers.vd, (0.5 + 1 / 587.5618) / (1 / 486.1327 - 1 / 656.2725), 1e-9);
  EXPECT_TRUE(std::isinf(abbe_numbers([](double) { return 1.5; }).vd));
}

}  // namespace
}  // namespace petzval
