// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/isp/mosaic_denoise.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "mosaic_samples.h"

namespace petzval {
namespace {

using test::bayer;

constexpr double full_well_e = 1000, read_noise_e = 3;
constexpr double scale_of_noise = 1 / full_well_e;
constexpr double offset_of_noise = read_noise_e * read_noise_e / (full_well_e * full_well_e);

/// The mosaic as a sensor would count it.
LinearMosaic counted(LinearMosaic mosaic, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> read(0, read_noise_e);
  for (float& value : mosaic.values) {
    std::poisson_distribution<int> photons(static_cast<double>(value) * full_well_e);
    value = static_cast<float>((photons(generator) + read(generator)) / full_well_e);
  }
  return mosaic;
}

double rms_difference(const LinearMosaic& a, const LinearMosaic& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i)
    sum += std::pow(static_cast<double>(a.values[i]) - static_cast<double>(b.values[i]), 2);
  return std::sqrt(sum / static_cast<double>(a.values.size()));
}

TEST(MosaicDenoise, KeepsTheMeanOfPlainSurfaces) {
  // 1 % of the level, and four standard errors of the mean; the biased inverse, squares of roots, would be
  // off by 0.25 electrons: 5 % at five. What is left of the noise: a fifth at most, for of 64 coefficients a
  // square keeps hardly more than its mean.
  for (const double electrons : {5.0, 30.0, 300.0}) {
    const test::Picture plain = [&](int, int, int) { return electrons / full_well_e; };
    const LinearMosaic noisy = counted(bayer(128, 128, "RGGB", plain), 3);
    LinearMosaic mosaic = noisy;
    denoise_mosaic(mosaic, 1, scale_of_noise, offset_of_noise);
    const double count = 128 * 128, mean = std::accumulate(mosaic.values.begin(), mosaic.values.end(), 0.0) /
                                           count * full_well_e;
    const double deviation = std::sqrt(electrons + read_noise_e * read_noise_e);
    EXPECT_NEAR(mean, electrons, 0.01 * electrons + 4 * deviation / std::sqrt(count)) << electrons;
    const LinearMosaic truth = bayer(128, 128, "RGGB", plain);
    EXPECT_LT(rms_difference(mosaic, truth), 0.2 * rms_difference(noisy, truth)) << electrons;
  }
}

TEST(MosaicDenoise, LeavesNoLatticeBetweenPixelsOfAChannel) {
  // The two greens of a plain surface differ by less than a tenth of their noise (0.054 when this was
  // written). Coefficients of noise beyond 2.7 deviations hold 2 (2.7 φ(2.7) + Q(2.7)) = 6 % of its energy, a
  // quarter of its deviation; the mean of squares that overlap, and the second pass, must take more than half
  // of that.
  const LinearMosaic noisy = counted(bayer(128, 128, "RGGB", [](int, int, int) { return 0.02; }), 9);
  const auto greens = [](const LinearMosaic& mosaic) {
    double sum = 0;
    for (int r = 0; r < mosaic.rows; r += 2)
      for (int c = 0; c < mosaic.columns; c += 2)
        sum += std::pow(static_cast<double>(mosaic.row(r)[static_cast<std::size_t>(c + 1)] -
                                            mosaic.row(r + 1)[static_cast<std::size_t>(c)]),
                        2);
    return std::sqrt(sum);
  };
  LinearMosaic mosaic = noisy;
  denoise_mosaic(mosaic, 1, scale_of_noise, offset_of_noise);
  EXPECT_LT(greens(mosaic), 0.1 * greens(noisy));
}

TEST(MosaicDenoise, KeepsDetailThatAMeanWouldNot) {
  // Stripes of eight pixels along the diagonal, coloured, their step as large as the noise of some pixels.
  // The error is below seven tenths of the noise (0.59 when this was written), and below that of the best of
  // means over 1, 9, 25, … pixels of the same channel.
  const test::Picture picture = [](int channel, int r, int c) {
    return ((r + c) / 8 % 2 ? 0.08 : 0.03) * (1 + 0.3 * channel);
  };
  const LinearMosaic truth = bayer(160, 120, "GRBG", picture), noisy = counted(truth, 11);
  LinearMosaic mosaic = noisy;
  denoise_mosaic(mosaic, 1, scale_of_noise, offset_of_noise);
  const double noise = rms_difference(noisy, truth);
  EXPECT_LT(rms_difference(mosaic, truth), 0.7 * noise);
  double best = noise;
  for (int reach = 1; reach <= 3; ++reach) {
    LinearMosaic means = noisy;
    for (int r = 0; r < noisy.rows; ++r)
      for (int c = 0; c < noisy.columns; ++c) {
        double sum = 0;
        int count = 0;
        for (int i = r - 2 * reach; i <= r + 2 * reach; i += 2)
          for (int j = c - 2 * reach; j <= c + 2 * reach; j += 2)
            if (i >= 0 && j >= 0 && i < noisy.rows && j < noisy.columns) {
              sum += static_cast<double>(noisy.row(i)[static_cast<std::size_t>(j)]);
              ++count;
            }
        means.row(r)[static_cast<std::size_t>(c)] = static_cast<float>(sum / count);
      }
    best = std::min(best, rms_difference(means, truth));
  }
  EXPECT_LT(rms_difference(mosaic, truth), best);
}

TEST(MosaicDenoise, LeavesWhatIsFarAboveTheNoise) {
  // A step of a hundred standard deviations is there as before within two of them, on both sides.
  const test::Picture step = [](int, int, int c) { return c < 30 ? 0.1 : 0.9; };
  LinearMosaic mosaic = bayer(60, 60, "RGGB", step);
  const LinearMosaic before = mosaic;
  constexpr double scale = 1e-4;
  denoise_mosaic(mosaic, 1, scale, 0);
  for (std::size_t i = 0; i < mosaic.values.size(); ++i)
    EXPECT_NEAR(mosaic.values[i], before.values[i],
                2 * std::sqrt(scale * static_cast<double>(before.values[i])));
}

TEST(MosaicDenoise, TakesAnyMosaicOfAnySize) {
  const std::vector<std::string> names = {"red", "green", "blue"};
  const Mosaic mosaics[] = {{1, 1, {0}},
                            {2, 2, {0, 1, 1, 2}},
                            {3, 3, {0, 1, 2, 1, 2, 0, 2, 0, 1}},
                            {4, 4, {0, 0, 1, 1, 0, 0, 1, 1, 1, 1, 2, 2, 1, 1, 2, 2}}};
  const test::Picture plain = [](int channel, int, int) { return 0.1 + 0.1 * channel; };
  for (const Mosaic& cells : mosaics)
    for (const auto& [columns, rows] : {std::pair(4, 4), std::pair(5, 7), std::pair(61, 50)}) {
      LinearMosaic mosaic = test::mosaic_of(columns, rows, cells, names, plain);
      const LinearMosaic before = mosaic;
      denoise_mosaic(mosaic, 1, 1e-6, 0);
      // The noise of the brightest is 5e-4.
      EXPECT_LT(rms_difference(mosaic, before), 5e-4) << cells.rows << " " << columns;
    }
}

TEST(MosaicDenoise, DoesNothingOrRefuses) {
  LinearMosaic mosaic = counted(bayer(40, 30, "RGGB", [](int, int, int) { return 0.1; }), 1);
  const LinearMosaic before = mosaic;
  denoise_mosaic(mosaic, 0, scale_of_noise, offset_of_noise);
  denoise_mosaic(mosaic, 1, 0, 0);
  EXPECT_EQ(mosaic.values, before.values);
  LinearMosaic long_period =
      test::mosaic_of(20, 20, {9, 9, std::vector<int>(81)}, {"grey"}, [](int, int, int) { return 0.1; });
  denoise_mosaic(long_period, 0, scale_of_noise, 0);
  EXPECT_THROW(denoise_mosaic(long_period, 1, scale_of_noise, 0), InputError);
  EXPECT_THROW(denoise_mosaic(mosaic, -1, scale_of_noise, 0), InputError);
  EXPECT_THROW(denoise_mosaic(mosaic, std::numeric_limits<double>::quiet_NaN(), scale_of_noise, 0),
               InputError);
}

TEST(MosaicDenoise, BytesDoNotDependOnThreads) {
  const LinearMosaic noisy =
      counted(bayer(130, 220, "RGGB",
                    [](int k, int r, int c) { return 0.1 + 0.05 * std::sin(0.3 * r + 0.1 * c + k); }),
              5);
  LinearMosaic one = noisy, two = noisy;
  {
    const ThreadLimit limit(1);
    denoise_mosaic(one, 1, scale_of_noise, offset_of_noise);
  }
  const ThreadLimit limit(2);
  denoise_mosaic(two, 1, scale_of_noise, offset_of_noise);
  EXPECT_EQ(one.values, two.values);
}

}  // namespace
}  // namespace petzval
