// SPDX-License-Identifier: BSD-3-Clause
// Denoising on pictures whose truth is known: noise falls, and what is no noise stays.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/render/film/denoise.h>

#include <cmath>
#include <functional>
#include <random>

namespace petzval::render {
namespace {

constexpr int columns = 96, rows = 64, bands = 4;
constexpr std::array<double, bands> colour{0.5, 1, 1.5, 0.8};
using Value = std::function<double(int column, int row)>;

/// Light of one colour with noise of a relative standard deviation in each half, the bands each their own or
/// all the same; one feature beside constant ones.
PictureHalves noisy(const Value& light, double noise, const Value& feature = {}, bool same_noise = false) {
  PictureHalves picture{columns, rows, bands, {}};
  std::mt19937 generator(7);
  std::normal_distribution<double> normal;
  constexpr std::size_t pixels = std::size_t{columns} * rows;
  for (PictureHalves::Half& half : picture.halves) {
    half.features.assign(PictureHalves::feature_count * pixels, 0.25f);
    for (std::size_t i = 0; i < pixels; ++i) {
      const int column = static_cast<int>(i) % columns, row = static_cast<int>(i) / columns;
      double factor = 1 + noise * normal(generator);
      for (const double each : colour) {
        if (!same_noise) factor = 1 + noise * normal(generator);
        half.light.push_back(static_cast<float>(each * light(column, row) * factor));
      }
      if (feature) half.features[i] = static_cast<float>(feature(column, row));
    }
  }
  return picture;
}

double level(const std::vector<float>& light, int column, int row) {
  double sum = 0;
  for (int band = 0; band < bands; ++band)
    sum += static_cast<double>(light[static_cast<std::size_t>((row * columns + column) * bands + band)]);
  double all = 0;
  for (const double each : colour) all += each;
  return sum / all;
}

double mean_level(const std::vector<float>& light, int column) {
  double sum = 0;
  for (int row = 0; row < rows; ++row) sum += level(light, column, row);
  return sum / rows;
}

/// RMS relative error of all bands.
double error(const std::vector<float>& light, const Value& truth) {
  double sum = 0;
  for (std::size_t i = 0; i < light.size(); ++i) {
    const int pixel = static_cast<int>(i) / bands;
    const double right = colour[i % bands] * truth(pixel % columns, pixel / columns);
    sum += std::pow(static_cast<double>(light[i]) / right - 1, 2);
  }
  return std::sqrt(sum / static_cast<double>(light.size()));
}

double even(int, int) {
  return 2;
}
double step(int column, int) {
  return column < columns / 2 ? 1 : 2;
}
double squares(int column, int row) {
  return (column / 2 + row / 2) % 2 == 0 ? 0.8 : 0.2;
}
double lit_squares(int column, int row) {
  return squares(column, row) * (1 + 0.01 * column);
}

TEST(Denoise, LeavesAPictureWithoutNoiseAsItIs) {
  const Value textured = [](int column, int row) {
    return (1 + 0.02 * column) * squares(column, row) * (row > 40 ? 30 : 1) + 0.003 * (row % 3);
  };
  const std::vector<float> light = denoised(noisy(textured, 0));
  double largest = 0;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      largest = std::max(largest, std::abs(level(light, column, row) / textured(column, row) - 1));
  EXPECT_LT(largest, 1e-3);
}

TEST(Denoise, TakesMostOfTheNoiseOutOfEvenLight) {
  // A mean over some of the 225 neighbours: at least 25 in effect, so a fifth. The halves' mean has 0.3/√2.
  const std::vector<float> light = denoised(noisy(even, 0.3));
  EXPECT_LT(error(light, even), 0.3 / std::sqrt(2.0) / 5);
  double sum = 0;
  for (int column = 0; column < columns; ++column) sum += mean_level(light, column) / columns;
  // As much light as there was: its noise is 0.3/√(2 · 4 · 6144), twice which chance seldom exceeds.
  EXPECT_NEAR(sum, 2, 2 * 3 * 0.3 / std::sqrt(2.0 * bands * columns * rows));
}

TEST(Denoise, SharesRareBrightSamplesAmongTheirNeighbours) {
  // One pixel in ten of each half has eleven times the light of the others. By itself it would look like a
  // lamp; the other half knows better.
  PictureHalves picture = noisy(even, 0);
  std::mt19937 generator(3);
  std::bernoulli_distribution bright(0.1);
  for (PictureHalves::Half& half : picture.halves)
    for (std::size_t i = 0; i < half.light.size(); i += bands) {
      const float factor = bright(generator) ? 5.5f : 0.5f;
      for (std::size_t band = 0; band < bands; ++band) half.light[i + band] *= factor;
    }
  const std::vector<float> light = denoised(picture);
  // The standard deviation of the halves' mean, and a third of it.
  EXPECT_LT(error(light, even), 1.5 / std::sqrt(2.0) / 3);
  double before = 0, after = 0;
  for (std::size_t i = 0; i < light.size(); ++i) {
    before += static_cast<double>(picture.halves[0].light[i] + picture.halves[1].light[i]) / 2;
    after += static_cast<double>(light[i]);
  }
  // Weights that had seen what they weigh would lose a tenth.
  EXPECT_NEAR(after / before, 1, 0.03);
}

TEST(Denoise, KeepsAnEdgeThatNoFeatureShows) {
  // The step is 3.3 times the noise of a half. A pixel beside it may not take more than 3 % of it.
  const std::vector<float> light = denoised(noisy(step, 0.15));
  EXPECT_NEAR(mean_level(light, columns / 2 - 1), 1, 0.03);
  EXPECT_NEAR(mean_level(light, columns / 2), 2, 0.03);
  EXPECT_LT(error(light, step), 0.15 / std::sqrt(2.0) / 4);
}

TEST(Denoise, KeepsATextureThatAFeatureShows) {
  // As noisy as the texture is deep: light alone would not tell. Contrast is kept to 3 %.
  const std::vector<float> light = denoised(noisy(lit_squares, 0.6, squares));
  double high = 0, low = 0;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      (squares(column, row) > 0.5 ? high : low) += level(light, column, row);
  EXPECT_NEAR(high / low, 4, 0.12);
  EXPECT_LT(error(light, lit_squares), 0.6 / std::sqrt(2.0) / 2);
  // Without the feature it is worse.
  EXPECT_GT(error(denoised(noisy(lit_squares, 0.6)), lit_squares), 1.5 * error(light, lit_squares));
}

TEST(Denoise, KeepsTheShapeOfASpectrum) {
  const std::vector<float> light = denoised(noisy(step, 0.3, {}, true));
  for (std::size_t i = 0; i < light.size(); ++i)
    ASSERT_NEAR(static_cast<double>(light[i]) / colour[i % bands],
                static_cast<double>(light[i - i % bands]) / colour[0], 1e-5 * 2);
}

TEST(Denoise, BiasGoesAsNoiseGoes) {
  double before = 1;
  for (const double noise : {0.4, 0.1, 0.025}) {
    const double now = error(denoised(noisy(lit_squares, noise)), lit_squares);
    EXPECT_LT(now, noise / std::sqrt(2.0)) << noise;
    EXPECT_LT(now, before / 2);
    before = now;
  }
}

TEST(Denoise, GivesTheSameBytesOnAnyNumberOfThreads) {
  const PictureHalves picture = noisy(lit_squares, 0.3, squares);
  const ThreadLimit one(1);
  const std::vector<float> alone = denoised(picture);
  const ThreadLimit two(2);
  EXPECT_EQ(denoised(picture), alone);
}

TEST(Denoise, TakesSmallPicturesAndRefusesHalvesOfAnotherSize) {
  PictureHalves one{1, 1, 1, {}};
  for (PictureHalves::Half& half : one.halves)
    half = {{2.0f}, std::vector<float>(PictureHalves::feature_count)};
  EXPECT_FLOAT_EQ(denoised(one)[0], 2);
  one.columns = 2;
  EXPECT_THROW(denoised(one), InputError);
  for (const auto& [width, height] : {std::array{2, 1}, std::array{1, 33}, std::array{40, 2}}) {
    const auto pixels = static_cast<std::size_t>(width * height);
    PictureHalves dark{width, height, 2, {}};
    for (PictureHalves::Half& half : dark.halves)
      half = {std::vector<float>(2 * pixels, 0.0f),
              std::vector<float>(PictureHalves::feature_count * pixels)};
    EXPECT_EQ(denoised(dark), dark.halves[0].light);
  }
}

}  // namespace
}  // namespace petzval::render
