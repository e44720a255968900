// SPDX-License-Identifier: BSD-3-Clause
// The transform of a polygon against sums over its inside and closed forms; the light of a star against
// means over that transform.
#include <gtest/gtest.h>
#include <petzval/base/units.h>
#include <petzval/flare/polygon_transform.h>
#include <petzval/flare/starburst.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_file.h>

#include <cmath>
#include <random>

namespace petzval {
namespace {

using Corners = std::vector<std::array<double, 2>>;

Corners regular(int count, double radius, double turn = 0.3) {
  Corners corners;
  for (int k = 0; k < count; ++k)
    corners.push_back(
        {radius * std::cos(turn + 2 * pi * k / count), radius * std::sin(turn + 2 * pi * k / count)});
  return corners;
}

TEST(PolygonTransform, OfARectangleIsAProductOfSincs) {
  const Corners box{{-1.5, -1}, {1.5, -1}, {1.5, 1}, {-1.5, 1}};
  for (const auto& [qx, qy] : {std::array{0.7, 1.9}, std::array{-3.0, 0.2}, std::array{12.0, -9.0}}) {
    const double expected = 6 * std::sin(1.5 * qx) / (1.5 * qx) * std::sin(qy) / qy;
    const std::complex<double> got = polygon_transform(box, {qx, qy});
    EXPECT_NEAR(got.real(), expected, 1e-13);
    EXPECT_NEAR(got.imag(), 0, 1e-13);
  }
  EXPECT_NEAR(polygon_transform(box, {0, 0}).real(), 6, 1e-14);
  EXPECT_NEAR(polygon_transform(box, {1e-4, 0}).real(), 6, 6 * 1e-8);
}

// The sum over a fine grid; its cells at the rim are in or out: 1/1000 of the area at most.
TEST(PolygonTransform, IsTheSumOverTheInside) {
  const Corners corners = regular(5, 1);
  for (const auto& [qx, qy] : {std::array{2.0, 1.0}, std::array{-5.0, 7.0}}) {
    std::complex<double> sum = 0;
    constexpr int side = 1500;
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j) {
        const double x = 2.0 * (i + 0.5) / side - 1, y = 2.0 * (j + 0.5) / side - 1;
        bool inside = true;
        for (std::size_t k = 0; k < 5; ++k) {
          const auto& [x0, y0] = corners[k];
          const auto& [x1, y1] = corners[(k + 1) % 5];
          inside = inside && (x1 - x0) * (y - y0) - (x - x0) * (y1 - y0) >= 0;
        }
        if (inside) sum += std::polar(4.0 / side / side, qx * x + qy * y);
      }
    EXPECT_LT(std::abs(polygon_transform(corners, {qx, qy}) - sum), 2e-3);
  }
}

// Means of the exact pattern over boxes that hold many fringes, at random points of it: on spikes and between
// them. Fringes of the pattern are λ/(2 NA) = 2.75 µm apart; a box of 40 µm holds 14, the mean of whose cross
// terms is within a tenth of the mean. (λ 550 nm, NA 0.1.)
TEST(Starburst, IsTheMeanOfTheExactPattern) {
  for (const int blades : {5, 6, 7}) {
    StarPupil pupil;
    pupil.corners = regular(blades, 0.1);
    const double lambda_mm = 550e-6, area = pupil.area(), half_mm = 0.02;
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> even(-1, 1);
    double worst = 0, all_exact = 0, all_mean = 0;
    for (int ring = 0; ring < 72; ++ring) {
      const double angle = 2 * pi * ring / 72, r = 0.3;
      const double x0 = r * std::cos(angle), y0 = r * std::sin(angle);
      double exact = 0, mean = 0;
      constexpr int count = 4000;
      for (int i = 0; i < count; ++i) {
        const double x = x0 + half_mm * even(random), y = y0 + half_mm * even(random);
        exact +=
            std::norm(polygon_transform(pupil.corners, {2 * pi / lambda_mm * x, 2 * pi / lambda_mm * y}));
        mean += star_irradiance(pupil, 550, x, y, 1e-3);
      }
      exact /= count * lambda_mm * lambda_mm * area, mean /= count;
      all_exact += exact, all_mean += mean;
      worst = std::max(worst, std::abs(mean / exact - 1));
    }
    EXPECT_NEAR(all_mean / all_exact, 1, 0.1) << blades;
    EXPECT_LT(worst, 0.5) << blades;
  }
}

// Energy: the share beyond a radius against one less what the exact pattern has within it.
TEST(Starburst, HasTheShareThatTheExactPatternLeavesOutside) {
  for (const int blades : {5, 6}) {
    StarPupil pupil;
    pupil.corners = regular(blades, 0.1);
    const double lambda_mm = 550e-6, area = pupil.area(), from_mm = 0.06;
    // Polar midpoints: twelve to a fringe.
    constexpr int radii = 300, turns = 2400;
    double within = 0;
    for (int i = 0; i < radii; ++i)
      for (int k = 0; k < turns; ++k) {
        const double r = from_mm * (i + 0.5) / radii, angle = 2 * pi * (k + 0.5) / turns;
        within += std::norm(polygon_transform(pupil.corners, {2 * pi / lambda_mm * r * std::cos(angle),
                                                              2 * pi / lambda_mm * r * std::sin(angle)})) *
                  r * (from_mm / radii) * (2 * pi / turns);
      }
    within /= lambda_mm * lambda_mm * area;
    ASSERT_LT(within, 1);
    EXPECT_NEAR(star_share_beyond(pupil, 550, from_mm, 1e-3) / (1 - within), 1, 0.1) << blades;
  }
}

// A round stop: Airy's encircled energy, 1 − J₀² − J₁², leaves 2/(πv) on average.
TEST(Starburst, OfARoundStopIsAirysTail) {
  StarPupil pupil;
  pupil.radius = 0.1;
  const double v = 2 * pi / 550e-6 * 0.06 * 0.1;
  EXPECT_NEAR(star_share_beyond(pupil, 550, 0.06, 1e-3) / (2 / (pi * v)), 1, 1e-3);
}

// Real rays: the circle of the directions is as wide as the working f-number says, and spikes stand across
// the edges.
TEST(Starburst, SeesTheStopAsTheImagePointDoes) {
  Lens lens = read_lens("cooke-triplet").lens;
  const GhostTracer round(lens, 550, {}, 0);
  BrightSource source;
  source.irradiance = {1};
  const SensorGeometry frame{300, 200, 20};
  const std::optional<StarPupil> circle = star_pupil(round, source, frame);
  ASSERT_TRUE(circle);
  // Paraxial numbers against real directions: spherical aberration of an f/5 lens, a per cent.
  EXPECT_NEAR(circle->radius * 2 * first_order(lens).working_f_number, 1, 0.02);
  lens.surfaces[lens.stop_index()].blades = {6, 0};
  const std::optional<StarPupil> six = star_pupil(GhostTracer(lens, 550, {}, 0), source, frame);
  ASSERT_TRUE(six);
  ASSERT_EQ(six->corners.size(), 6U);
  // Corners at the top and bottom: upright edges at the sides, whose spike lies level.
  EXPECT_GT(star_irradiance(*six, 550, 1, 0, 0.01), 20 * star_irradiance(*six, 550, 0, 1, 0.01));
  EXPECT_NEAR(six->area() / circle->area(), 6 / (2 * pi) * std::sin(2 * pi / 6), 0.02);
}

TEST(Starburst, LayerGivesBackWhatItTakes) {
  Lens lens = read_lens("cooke-triplet").lens;
  lens.surfaces[lens.stop_index()].blades = {6, 10};
  BrightSource source;
  source.irradiance = {1};
  // 40 mm wide: 0.1 mm from the core onwards, light per radius being even in 1/r, 1 % leaves the frame.
  const SensorGeometry frame{1000, 1000, 40};
  const SpectralImage layer = starburst_light(lens, frame, {550}, {&source, 1});
  double positive = 0, negative = 0;
  for (const float value : layer.values()) (value > 0 ? positive : negative) += double(value);
  ASSERT_GT(positive, 0);
  EXPECT_NEAR(positive / -negative, 1, 0.05);
}

}  // namespace
}  // namespace petzval
