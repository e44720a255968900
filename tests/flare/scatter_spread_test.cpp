// SPDX-License-Identifier: BSD-3-Clause
// Scattered light against photons that are turned aside at random.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/flare/scatter_spread.h>
#include <petzval/lens/lens_file.h>
#include <petzval/numeric/quadrature.h>

#include <algorithm>
#include <cmath>

#include "scattered_photons.h"

namespace petzval {
namespace {

constexpr double scatter_nm = 587.5618, lobe_l = 0.03, lobe_s = -1.5;

Scatter lobe() {
  Scatter scatter;
  scatter.b0_per_sr = 0.05, scatter.l = lobe_l, scatter.s = lobe_s, scatter.wavelength_nm = scatter_nm;
  return scatter;
}

/// Squares on the sensor, from the image point outwards, and what falls on them.
struct Square {
  double x_mm, y_mm, half_mm;
  int hits = 0;
  double expected = 0;
};

std::vector<Square> squares_about(const SourceImage& image) {
  std::vector<Square> squares;
  for (const auto& [dx, dy, half] : {std::array{1.5, 0.0, 0.5}, std::array{-2.0, 2.0, 0.7},
                                     std::array{0.0, -5.0, 1.0}, std::array{7.0, 3.0, 1.5}})
    squares.push_back({image.x_mm + dx, image.y_mm + dy, half});
  return squares;
}

struct ScatterCase {
  const char* lens;
  double right, up;
  std::vector<std::size_t> surfaces;
};

class ScatteredLight : public testing::TestWithParam<ScatterCase> {};

// One surface scatters all that meets it, in photons; the lens's light is that over its share. Sums within
// three standard errors; the squares together by χ², which chance exceeds once in 10⁴.
TEST_P(ScatteredLight, IsThatOfPhotonsTurnedAsideAtRandom) {
  const ScatterCase& with = GetParam();
  Lens lens = read_lens(with.lens).lens;
  BrightSource source;
  source.right = with.right, source.up = with.up;
  const test::ScatteringLens photons(lens, scatter_nm);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> even(-1, 1);
  const double length = std::sqrt(with.right * with.right + with.up * with.up + 1);
  const std::array<double, 3> along{-with.right / length, -with.up / length, 1 / length};
  const double half = 1.3 * *lens.surfaces[0].semi_diameter_mm;
  constexpr int count = 2000000;
  const double each_mm2 = 4 * half * half * along[2] / count;
  double chi_sq = 0;
  int bins = 0;
  for (const std::size_t surface : with.surfaces) {
    Lens one = lens;
    one.surfaces[surface].scatter = lobe();
    const ScatterTracer tracer(one, scatter_nm, {});
    SourceImage image;
    tracer.light(SourceBeam(source), 16, &image);
    std::vector<Square> squares = squares_about(image);
    const QuadratureRule rule = gauss_legendre(4, -1, 1);
    std::vector<std::array<double, 2>> places;
    for (const Square& square : squares)
      for (const double u : rule.nodes)
        for (const double v : rule.nodes)
          places.push_back({square.x_mm + u * square.half_mm, square.y_mm + v * square.half_mm});
    const ScatterSpread spread = scatter_spread(tracer, source, places, {.across = 64});
    const double share = tracer.bsdf(surface).shares(1, 1).polish;
    std::size_t place = 0;
    for (Square& square : squares)
      for (const double wu : rule.weights)
        for (const double wv : rule.weights)
          square.expected +=
              wu * wv * square.half_mm * square.half_mm * spread.at(place++) / share / each_mm2;
    for (int i = 0; i < count; ++i) {
      const auto end = photons.follow({half * even(random), half * even(random), 0}, along, surface, lobe_l,
                                      lobe_s, random);
      if (!end) continue;
      for (Square& square : squares)
        if (std::abs((*end)[0] - square.x_mm) < square.half_mm &&
            std::abs((*end)[1] - square.y_mm) < square.half_mm)
          ++square.hits;
    }
    double expected = 0, hits = 0;
    for (const Square& square : squares) {
      expected += square.expected, hits += square.hits;
      if (square.expected < 20) continue;
      chi_sq += std::pow(square.hits - square.expected, 2) / square.expected;
      ++bins;
    }
    EXPECT_GT(hits, 1000) << surface;
    EXPECT_NEAR(hits, expected, 3 * std::sqrt(expected)) << surface;
  }
  ASSERT_GT(bins, 5);
  // Wilson and Hilferty's normal deviate of χ²; 3.72 is exceeded once in 10⁴.
  const double deviate = (std::cbrt(chi_sq / bins) - (1 - 2.0 / (9 * bins))) / std::sqrt(2.0 / (9 * bins));
  EXPECT_LT(deviate, 3.72) << chi_sq << " of " << bins;
}

INSTANTIATE_TEST_SUITE_P(TwoLenses, ScatteredLight,
                         testing::Values(ScatterCase{"cooke-triplet", 0, 0, {0, 2, 5}},
                                         ScatterCase{"cooke-triplet", 0.2, 0.13, {0, 2, 5}},
                                         ScatterCase{"double-gauss", 0, 0, {0, 3, 9}},
                                         ScatterCase{"double-gauss", -0.12, 0.1, {0, 3, 9}}),
                         [](const auto& info) {
                           std::string name = info.param.lens;
                           std::ranges::replace(name, '-', '_');
                           return name + (info.param.right == 0 ? "_on_axis" : "_off_axis");
                         });

// Light so steep that the surfaces behind would not pass it on scatters from the front ones none the less.
// What two mirror images of a source scatter to a place in the plane between them is one number, for any
// order of the rays.
TEST(ScatterSpread, OfSteepLightIsAlikeOnBothSides) {
  const Lens lens = with_scatter(read_lens("cooke-triplet").lens, lobe());
  const ScatterTracer tracer(lens, scatter_nm, {});
  const std::array<std::array<double, 2>, 1> place{{{0, 8}}};
  std::array<ScatterSpread, 2> sides;
  for (const std::size_t side : {0, 1}) {
    BrightSource source;
    source.right = side == 0 ? 0.3 : -0.3, source.up = 0.4;
    sides[side] = scatter_spread(tracer, source, place, {.across = 24});
  }
  for (std::size_t s = 0; s < tracer.surface_count(); ++s) {
    EXPECT_GT(sides[0].by_surface[0][s], 0) << s;
    EXPECT_NEAR(sides[1].by_surface[0][s] / sides[0].by_surface[0][s], 1, 1e-6) << s;
  }
}

// All light of the image is what the lens lets through less what all surfaces scatter.
TEST(ScatterShare, IsTakenFromTheImage) {
  const Lens lens = with_scatter(read_lens("cooke-triplet").lens, lobe());
  const ScatterTracer tracer(lens, scatter_nm, {});
  SourceImage image;
  tracer.light(SourceBeam(BrightSource()), 32, &image);
  const double share = tracer.bsdf(0).shares(1, 1).polish;
  // Six surfaces between air and glass; the stop is none.
  std::size_t surfaces = 0;
  for (std::size_t i = 0; i < tracer.surface_count(); ++i) surfaces += tracer.bsdf(i).scatters();
  EXPECT_EQ(surfaces, 6U);
  EXPECT_NEAR(image.scattered_share(), 1 - std::pow(1 - share, 6), 1e-12);
}

TEST(ScatterTracerInput, IsRefusedWithAWordOfWhatWouldBeRight) {
  const Lens lens = read_lens("cooke-triplet").lens;
  EXPECT_FALSE(states_scatter(lens));
  EXPECT_FALSE(ScatterTracer(lens, scatter_nm, {}).scatters());
  EXPECT_THROW(with_scatter(lens, Scatter()), InputError);
  const ScatterTracer tracer(with_scatter(read_lens("tessar").lens, lobe()), scatter_nm, {});
  EXPECT_THROW(scatter_spread(tracer, {}, {}, {.across = 2}), InputError);
}

}  // namespace
}  // namespace petzval
