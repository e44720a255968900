// SPDX-License-Identifier: BSD-3-Clause
// Power spectra of scenes against what laws say: of edges, of noise, of stripes.
#include <gtest/gtest.h>
#include <petzval/imaging/scene_detail.h>
#include <petzval/scene/charts.h>

#include <cmath>
#include <numeric>
#include <random>

namespace petzval {
namespace {

double power_between(const SceneDetail& detail, double from_cpp, double to_cpp) {
  double sum = 0;
  for (const std::vector<double>& zone : detail.power)
    for (std::size_t band = 0; band < zone.size(); ++band)
      if (DetailBands::middle_cpp(band) > from_cpp && DetailBands::middle_cpp(band) < to_cpp)
        sum += zone[band];
  return sum;
}

// Steps of height h, one every p pixels: h²/(2π²f²p) a cycle per pixel, along rows and along columns. Of the
// 64 steps a pixel it is the transform of sums that comes out, (πf/64)²/sin²(πf/64) times as much: 1.03 at 6.
TEST(SceneDetail, OfAChartGoesOnAsEdgesDo) {
  ChartOptions options;
  options.columns = 512, options.rows = 384;
  options.wavelengths_nm = {550};
  constexpr double samples_per_pixel = 2, squares_across = 32;
  const Scene board = checkerboard_chart(options, int(squares_across));
  const double white = double(board.drawing()->figures[0].radiance[0]),
               black = double(board.drawing()->ground[0]);
  const SceneDetail detail = detail_of(board, 0, samples_per_pixel, {256, 192, 5});
  const double of_edges =
      std::pow((white - black) / M_PI, 2) / 2 / (options.columns / squares_across / samples_per_pixel);
  for (const double f : {1.0, 2.0, 4.0})
    EXPECT_NEAR(power_between(detail, f, 2 * f) / (2 * of_edges * (1 / f - 1 / (2 * f))), 1, 0.1) << f;
  EXPECT_NEAR(detail.mean, (white + black) / 2, 0.01 * white);
  EXPECT_NEAR(power_between(detail, 0, 20), 2 * std::pow((white - black) / 2, 2), 0.05 * white * white);
}

// An edge at 45° crosses each strip once. One w pixels wide shows it as a ramp w long, sinc²(wf) of a jump's
// power: strips of whole pixels would hide all that is fine.
TEST(SceneDetail, SeesFineWavesAslant) {
  ChartOptions options;
  options.columns = options.rows = 384;
  options.wavelengths_nm = {550};
  const Scene scene = slanted_edge_chart(options, 45);
  const double white = double(scene.drawing()->figures[0].radiance[0]),
               black = double(scene.drawing()->ground[0]);
  constexpr int side = 192;
  constexpr double strip = 0.25;
  const SceneDetail detail = detail_of(scene, 0, 2, {side, side, 5});
  for (const double f : {0.5, 1.0, 2.0}) {
    double law = 0;
    constexpr int steps = 1000;
    for (int i = 0; i < steps; ++i) {
      const double at = f * (1 + (i + 0.5) / steps), phase = M_PI * strip * at;
      law += std::pow((white - black) / (M_PI * at) * std::sin(phase) / phase, 2) / 2 / side * f / steps;
    }
    EXPECT_NEAR(power_between(detail, f, 2 * f) / (2 * law), 1, 0.1) << f;
  }
}

// White noise on samples as wide as pixels: all frequencies alike, less what straight lines between samples
// take, sinc⁴; the rest are its images.
TEST(SceneDetail, OfSamplesIsThatOfStraightLinesBetweenThem) {
  constexpr int side = 256;
  Scene scene(side, side, {550}, 30, std::nullopt);
  std::mt19937 random(1807);
  std::normal_distribution<float> noise(10, 1);
  for (float& value : scene.band(0)) value = noise(random);
  const SceneDetail detail = detail_of(scene, 0, 1, {side, side, 5});
  const auto law = [](double from, double to) {
    double sum = 0;
    constexpr int steps = 1000;
    for (int i = 0; i < steps; ++i) {
      const double f = from + (i + 0.5) / steps * (to - from);
      sum += std::pow(std::sin(M_PI * f) / (M_PI * f), 4);
    }
    return 2 * 2 * sum / steps * (to - from);  // both signs of frequency, both directions
  };
  EXPECT_NEAR(power_between(detail, 0.1, 0.5) / law(0.1, 0.5), 1, 0.03);
  EXPECT_NEAR(power_between(detail, 0.5, 0.9) / law(0.5, 0.9), 1, 0.05);
  EXPECT_NEAR(power_between(detail, 1.1, 1.9) / law(1.1, 1.9), 1, 0.1);
  EXPECT_NEAR(detail.variance_of_neighbours, 1, 0.03);
}

// Upright stripes: left and right of the axis they cross the radius, above and below it they run along it.
TEST(SceneDetail, KnowsTheDirectionOfWaves) {
  Scene scene(512, 512, {550}, 30, std::nullopt);
  for (std::size_t i = 0; i < scene.band_size(); ++i) scene.band(0)[i] = i / 4 % 2 == 0 ? 1 : 0;
  const auto share_along_radius = [&](const SensorGeometry& sensor) {
    const SceneDetail detail = detail_of(scene, 0, 1, sensor);
    const auto power = [&](std::size_t zone) {
      return std::accumulate(detail.power[zone].begin(), detail.power[zone].end(), 0.0);
    };
    const double along = power(FrameZones::along_radius(6)), across = power(FrameZones::across_radius(6));
    return along / (along + across);
  };
  EXPECT_GT(share_along_radius({480, 32, 5}), 0.95);
  EXPECT_LT(share_along_radius({32, 480, 5}), 0.05);
}

// Each lens shows the scene at another scale: what one has looked at must not be what the next one gets.
TEST(KnownDetail, IsThatOfAFirstLookWhateverCameBefore) {
  ChartOptions options;
  options.columns = 128, options.rows = 96;
  options.wavelengths_nm = {500, 600};
  const Scene board = checkerboard_chart(options, 8);
  const SensorGeometry sensor{64, 48, 5}, wider{80, 48, 5};
  const double scale = KnownDetail::rounded_scale(2), step = std::exp2(1.0 / 64);
  EXPECT_NEAR(scale, 2, 0.012);
  KnownDetail known;
  const auto expect_as_first = [&](int band, double samples_per_pixel, const SensorGeometry& geometry) {
    KnownDetail fresh;
    const SceneDetail &one = known.of(board, band, samples_per_pixel, geometry),
                      &other = fresh.of(board, band, samples_per_pixel, geometry);
    EXPECT_EQ(one.power, other.power);
    EXPECT_EQ(one.mean, other.mean);
    EXPECT_EQ(one.variance_of_neighbours, other.variance_of_neighbours);
  };
  for (const double off : {1.0, 1.004, 0.996}) expect_as_first(0, off * scale, sensor);
  EXPECT_EQ(known.looks(), 1);
  expect_as_first(1, scale, sensor);
  expect_as_first(0, scale, wider);
  expect_as_first(0, scale * step, sensor);
  expect_as_first(0, scale / step, sensor);
  expect_as_first(0, scale, sensor);  // long forgotten, or not
  EXPECT_GE(known.looks(), 5);
}

}  // namespace
}  // namespace petzval
