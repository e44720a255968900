// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/measure/sfr/quantisation_noise.h>

#include <cmath>
#include <numeric>
#include <vector>

namespace petzval {
namespace {

constexpr double step = 1e-3;

/// The variance of the sum of the errors of samples, over that of their noise, at the most noise [steps²]
/// with which rounding is not left out.
double last_share(const std::vector<double>& values, double& most_noise2) {
  std::vector<double> levels(1001);
  for (std::size_t i = 0; i < levels.size(); ++i) levels[i] = static_cast<double>(i) * step;
  double share = 0;
  for (double noise2 = 0; noise2 < 1; noise2 += 0.002) {
    const std::vector<double> variance(values.size(), step * step * (noise2 + 1.0 / 12));
    const QuantisationNoise rounding(levels, values, variance);
    if (rounding.none()) break;
    most_noise2 = noise2;
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(1, 1);
    rounding.add_spread([](std::size_t, double weight, double* sum) { *sum += weight; }, covariance);
    share = covariance(0, 0) / std::accumulate(variance.begin(), variance.end(), 0.0);
  }
  return share;
}

// What is left out is a hundredth at most, and not so little that work would be done for nothing.
TEST(QuantisationNoise, IsLeftOutWhereNoiseHidesIt) {
  double noise2 = 0;
  const std::vector<double> one_value(2000, 0.50031);
  const double share = last_share(one_value, noise2);
  EXPECT_LT(share, 0.01);
  EXPECT_GT(share, 0.003);
  EXPECT_GT(noise2, 0.25);
}

// Where no two samples share a step, errors of rounding average out as noise does.
TEST(QuantisationNoise, OfSamplesFarApartIsHiddenByLessNoise) {
  std::vector<double> values;
  for (int i = 0; i < 200; ++i) values.push_back((5 * i + 0.31) * step);
  double noise2 = 0;
  const double share = last_share(values, noise2);
  EXPECT_LT(share, 0.01);
  EXPECT_GT(share, 0.003);
  EXPECT_LT(noise2, 0.12);
}

// Errors of rounding have a variance of a twelfth of a step squared, wherever in a step the values lie. Half
// a step apart their correlation is that of a sawtooth, Σ (−1)^k / k² over Σ 1 / k² for six harmonics, times
// the cosine of 45° with which the places share their windows.
TEST(QuantisationNoise, OfTwoValuesIsThatOfASawtooth) {
  std::vector<double> levels(101);
  for (std::size_t i = 0; i < levels.size(); ++i) levels[i] = static_cast<double>(i) * step;
  constexpr std::size_t count = 50;  // samples of each value
  double products = 0, squares = 0;
  for (int k = 1; k <= 6; ++k) {
    products += (k % 2 == 0 ? 1.0 : -1.0) / (k * k);
    squares += 1.0 / (k * k);
  }
  for (const double place : {40.01, 40.31, 40.52, 40.93}) {
    std::vector<double> values(count, place * step);
    values.resize(2 * count, (place + 0.5) * step);
    const std::vector<double> variance(values.size(), step * step / 12);
    const QuantisationNoise rounding(levels, values, variance);
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(2, 2);
    rounding.add_spread([](std::size_t i, double weight, double* sum) { sum[i / count] += weight; },
                        covariance);
    const double in_step = (std::floor((place - 40) * 16) + 0.5) / 16, quarter = std::acos(0.0);
    const double shared = in_step < 0.5 ? std::cos(0.5 * quarter)
                                        : std::sin(quarter * in_step) * std::cos(quarter * (in_step - 0.5));
    const double of_all = std::pow(double(count) * step, 2) / 12;
    EXPECT_NEAR(covariance(0, 0) / of_all, 1, 1e-9) << place;
    EXPECT_NEAR(covariance(1, 1) / of_all, 1, 1e-9) << place;
    EXPECT_NEAR(covariance(1, 0) / of_all, products / squares * shared, 1e-9) << place;
  }
}

}  // namespace
}  // namespace petzval
