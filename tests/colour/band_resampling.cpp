// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/colour/band_resampling.h>
#include <petzval/colour/spectrum.h>

#include <cmath>
#include <random>

namespace petzval {
namespace {

/// Radiance by the trapezoid rule, written here once more.
double sum_over(const std::vector<double>& nm, const std::vector<double>& values) {
  double sum = 0;
  for (std::size_t i = 1; i < nm.size(); ++i) sum += (nm[i] - nm[i - 1]) * (values[i] + values[i - 1]) / 2;
  return sum;
}

/// Irregular wavelengths from `first` to `last`.
std::vector<double> random_grid(std::mt19937& random, double first, double last, int count) {
  std::uniform_real_distribution<double> step(0.1, 1);
  std::vector<double> nm{0};
  while (nm.size() < static_cast<std::size_t>(count)) nm.push_back(nm.back() + step(random));
  for (double& at : nm) at = first + (last - first) * at / nm.back();
  nm.back() = last;
  return nm;
}

Spectrum spiky(std::mt19937& random, std::vector<double> nm) {
  std::uniform_real_distribution<double> value(0, 1);
  std::vector<double> values;
  for (std::size_t i = 0; i < nm.size(); ++i) values.push_back(std::pow(value(random), 8));
  return {std::move(nm), std::move(values)};
}

TEST(BandResampling, KeepsTheIntegralAndMakesNothingNegative) {
  std::mt19937 random(1);
  for (int run = 0; run < 200; ++run) {
    const Spectrum from = spiky(random, random_grid(random, 400, 700, 3 + run % 60));
    const std::vector<double> to = random_grid(random, 405 + run % 50, 690 - run % 70, 2 + run % 37);
    const std::vector<double> values = resampled(from, to).values();
    const double wanted = from.integral(to.front(), to.back());
    EXPECT_NEAR(sum_over(to, values), wanted, 1e-12 * (1 + wanted)) << run;  // rounding
    for (const double value : values) EXPECT_GE(value, 0) << run;
  }
}

TEST(BandResampling, TheSameBandsStayAsTheyAre) {
  std::mt19937 random(2);
  const Spectrum from = spiky(random, random_grid(random, 380, 780, 41));
  const std::vector<double> same = resampled(from, from.wavelengths_nm()).values();
  for (std::size_t i = 0; i < same.size(); ++i) EXPECT_NEAR(same[i], from.values()[i], 1e-14);
  // So do neighbours without the rest.
  const std::vector<double> middle(from.wavelengths_nm().begin() + 10, from.wavelengths_nm().begin() + 20);
  const std::vector<double> kept = resampled(from, middle).values();
  for (std::size_t i = 0; i < kept.size(); ++i) EXPECT_NEAR(kept[i], from.values()[10 + i], 1e-14);
}

TEST(BandResampling, BandsInBetweenLieOnTheLine) {
  const Spectrum from({400, 500, 600}, {1, 3, 0});
  const std::vector<double> to{400, 425, 450, 500, 525, 600};
  const std::vector<double> expected{1, 1.5, 2, 3, 2.25, 0};
  const std::vector<double> values = resampled(from, to).values();
  for (std::size_t i = 0; i < to.size(); ++i) EXPECT_NEAR(values[i], expected[i], 1e-14) << to[i];
}

TEST(BandResampling, ALineThatFallsBetweenBandsIsNotLost) {
  // A lamp's line at 546 nm, 2 nm wide, in bands of 20 nm: its light is in the two about it.
  const Spectrum line({400, 545, 546, 547, 700}, {0, 0, 10, 0, 0});
  std::vector<double> bands;
  for (int nm = 400; nm <= 700; nm += 20) bands.push_back(nm);
  const std::vector<double> values = resampled(line, bands).values();
  EXPECT_NEAR(values[7] * 20, 10 * 14 / 20.0, 1e-12);  // 540 nm
  EXPECT_NEAR(values[8] * 20, 10 * 6 / 20.0, 1e-12);   // 560 nm
}

TEST(BandResampling, OneBandIsTheCurve) {
  const Spectrum from({400, 500}, {1, 3});
  EXPECT_NEAR(resampled(from, std::vector<double>{425}).values()[0], 1.5, 1e-14);
  EXPECT_NEAR(resampled(from, std::vector<double>{500}).values()[0], 3, 1e-14);
  EXPECT_NEAR(resampled(from, std::vector<double>{500 + 5e-7}).values()[0], 3, 1e-14);  // a file's rounding
  EXPECT_THROW(resampled(from, std::vector<double>{500.1}), InputError);
  EXPECT_THROW(resampled(from, std::vector<double>{399, 450}), InputError);
}

}  // namespace
}  // namespace petzval
