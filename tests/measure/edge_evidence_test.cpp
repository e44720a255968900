// SPDX-License-Identifier: BSD-3-Clause
// What samples say for an edge and against light that changes smoothly.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/measure/sfr/edge_evidence.h>
#include <petzval/measure/sfr/measure_picture.h>

#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace petzval {
namespace {

constexpr int size_px = 300;

PicturePlanes picture_of(const std::function<double(double x, double y)>& light, double noise,
                         unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 1);
  Plane plane{size_px, size_px, {}};
  for (int row = 0; row < size_px; ++row)
    for (int column = 0; column < size_px; ++column)
      plane.values.push_back(light(column + 0.5, row + 0.5) + noise * normal(random));
  PicturePlanes picture;
  picture.columns = picture.rows = size_px;
  picture.planes = {plane};
  return picture;
}

std::size_t edges_in(const PicturePlanes& picture) try {
  return measure_sfr(picture).size();
} catch (const InputError&) {
  return 0;
}

/// Independent normal values, each the mean of a square of so many, on a lattice.
std::vector<EdgeSample> averaged_noise(int square, int spacing) {
  constexpr int across = 120;
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, 1);
  std::vector<double> values;
  for (int i = 0; i < across * across; ++i) values.push_back(normal(random));
  std::vector<EdgeSample> samples;
  for (int row = 0; row + square <= across; ++row)
    for (int column = 0; column + square <= across; ++column) {
      double sum = 0;
      for (int y = 0; y < square; ++y)
        for (int x = 0; x < square; ++x)
          sum += values[static_cast<std::size_t>((row + y) * across + column + x)];
      samples.push_back({spacing * column + 10.5, spacing * row + 20.5, sum});
    }
  return samples;
}

TEST(EdgeEvidence, AveragedNoiseIsWorthItsSquares) {
  // The correlation of means over a square falls linearly: along either axis it sums up to the square's side.
  for (const int spacing : {1, 2})
    for (const int square : {1, 2, 4, 6}) {
      const std::vector<EdgeSample> samples = averaged_noise(square, spacing);
      const double expected = static_cast<double>(samples.size()) / (square * square);
      EXPECT_NEAR(independent_samples(samples, spacing) / expected, 1, 0.2) << square << ' ' << spacing;
    }
}

TEST(EdgeEvidence, GratingsAndSmoothLightHaveNoEdges) {
  // Halfway between their dark and bright, contours are straight.
  for (const double noise : {0.0, 0.05, 0.1})
    for (unsigned seed = 1; seed <= 2; ++seed)
      for (const double period : {35.0, 50.0})
        EXPECT_EQ(edges_in(picture_of(
                      [&](double x, double y) {
                        return 0.5 + 0.5 * std::sin(2 * pi * (0.99 * x + 0.14 * y) / period);
                      },
                      noise, seed)),
                  0u)
            << noise << ' ' << seed << ' ' << period;
  for (const double noise : {0.0, 0.1})
    for (const double blur_px : {8.0, 20.0})
      for (unsigned seed = 1; seed <= 10; ++seed) {
        // Noise blurred by a Gaussian, as waves of random direction and phase.
        std::mt19937 random(seed);
        std::normal_distribution<double> frequency(0, 1 / blur_px);
        std::uniform_real_distribution<double> phase(0, 2 * pi);
        std::vector<std::array<double, 3>> waves(50);
        for (auto& [u, v, p] : waves) u = frequency(random), v = frequency(random), p = phase(random);
        EXPECT_EQ(edges_in(picture_of(
                      [&](double x, double y) {
                        double sum = 0;
                        for (const auto& [u, v, p] : waves) sum += std::cos(u * x + v * y + p);
                        return 0.5 + 0.04 * sum;
                      },
                      noise, seed)),
                  0u)
            << noise << ' ' << blur_px << ' ' << seed;
      }
}

TEST(EdgeEvidence, EdgesStandOutFromNoise) {
  // Squares of 50 pixels, 100 apart, blurred by a Gaussian of one pixel.
  constexpr double blur_px = 1;
  for (const double noise : {0.0, 0.02, 0.1, 0.18})
    EXPECT_EQ(edges_in(picture_of(
                  [&](double x, double y) {
                    const auto inside = [&](double across) {
                      const double from = std::remainder(across - 50, 100);
                      const double scale = blur_px * std::sqrt(2.0);
                      return 0.5 * (std::erf((from + 25) / scale) - std::erf((from - 25) / scale));
                    };
                    return inside(x + 0.1 * (y - 150)) * inside(y - 0.1 * (x - 150));
                  },
                  noise, 7)),
              36u)
        << noise;
}

TEST(EdgeEvidence, ANoteForEachReasonCountsWhatIsLeftOut) {
  // An edge beside a grating whose outlines are slopes of light.
  std::vector<std::string> notes;
  Context context;
  context.note = [&](const std::string& text) { notes.push_back(text); };
  measure_sfr(picture_of(
                  [](double x, double y) {
                    if (x < 200) return 0.5 + 0.3 * std::sin(2 * pi * x / 40);
                    return 0.5 + 0.3 * std::erf((x - 250 + 0.1 * (y - 150)) / std::sqrt(2.0));
                  },
                  0, 1),
              {}, "photo.png", context);
  std::erase_if(notes,
                [](const std::string& text) { return !text.ends_with("explains the pixels as well"); });
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_TRUE(notes[0].starts_with("photo.png: ")) << notes[0];
  EXPECT_NE(notes[0].find(" edges are left out (from "), std::string::npos) << notes[0];
  EXPECT_NE(notes[0].find(" more): no edge stands out: light that changes"), std::string::npos) << notes[0];
}

}  // namespace
}  // namespace petzval
