// SPDX-License-Identifier: BSD-3-Clause
// Edges found in pictures of known targets, and what the rest of a target does to them.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/measure/sfr/find_edges.h>
#include <petzval/measure/sfr/measure_edge.h>
#include <petzval/measure/sfr/missing_target.h>
#include <petzval/target/render_target.h>
#include <petzval/target/test_charts.h>

#include <cmath>
#include <random>

namespace petzval {
namespace {

struct Shot {
  Plane plane;
  std::unique_ptr<RadialOtf> otf;
  TargetOptions options;
  double truth(double f, double normal_deg) const {
    const double angle = normal_deg * M_PI / 180;
    return std::abs(transfer(*otf, options, f * std::cos(angle), f * std::sin(angle)));
  }
};

Shot shoot(const TargetScene& scene, int size, double f_number, double w020 = 0) {
  Shot shot;
  shot.otf = radial_pupil_otf({{w020}, 0}, 550, f_number);
  shot.options.columns = shot.options.rows = size, shot.options.pitch_um = 4.73;
  const TargetImage image = render_target(scene, *shot.otf, shot.options);
  shot.plane = {image.columns(), image.rows(), image.values()};
  return shot;
}

TargetScene square_at(double angle_deg, double side = 100) {
  TargetScene scene;
  scene.polygons.push_back({{rectangle({120, 120}, side, side, angle_deg)}, 0, 0});
  return scene;
}

double worst_error(const Shot& shot, const EdgeMeasurement& m) {
  double worst = 0;
  for (std::size_t i = 2; i <= 50; ++i)
    worst = std::max(worst,
                     std::abs(m.sfr[i] - shot.truth(m.frequencies_cpp[i], m.line.normal_rad * 180 / M_PI)));
  return worst;
}

TEST(FindEdges, FindsTheFourSidesOfARectangle) {
  for (const double angle : {0.5, 5.0, 20.0, 43.0}) {
    const Shot shot = shoot(square_at(angle), 240, 8);
    const FoundEdges found = find_edges(shot.plane);
    ASSERT_EQ(found.edges.size(), 4u) << angle;
    for (const FoundEdge& edge : found.edges) {
      EXPECT_NEAR(edge.length_px(), 100, 2);
      EXPECT_TRUE(edge.corner_at_from && edge.corner_at_to);
      const double direction = std::atan2(edge.to.y - edge.from.y, edge.to.x - edge.from.x) * 180 / M_PI;
      EXPECT_NEAR(std::remainder(direction - angle, 90), 0, 1) << "chords between rounded corners";
    }
  }
}

TEST(FindEdges, ARectanglesEdgesMeasureAsHalfPlanesDo) {
  // The tails of the other three sides are modelled; without that the error is 3e-3 (the second expectation
  // shows that it matters).
  for (const double angle : {5.0, 30.0}) {
    const Shot shot = shoot(square_at(angle), 240, 8);
    const FoundEdges found = find_edges(shot.plane);
    for (const FoundEdge& edge : found.edges) {
      SfrOptions options;
      const double ignorant = worst_error(shot, measure_edge(samples_about(shot.plane, edge), 1, options));
      options.missing_target = MissingTarget::where_sampled(edge);
      const EdgeMeasurement m = measure_edge(samples_about(shot.plane, edge), 1, options);
      EXPECT_LT(worst_error(shot, m), 3e-4);
      EXPECT_GT(ignorant, 1e-3);
      EXPECT_NEAR(std::remainder(m.line.angle_deg() - angle, 90), 0, 1e-3);
    }
  }
}

TEST(FindEdges, CornersAddLessThanATenthOfWhatNoiseScatters) {
  // Edges are found in a noisy picture and measured in the same without noise: what is off then, corners add.
  // Beside it the scatter of MTF50 of edges of 60 pixels (docs/ACCURACY.md); with 0.3 waves of defocus, too,
  // whose light looks farther round corners.
  struct Row {
    double noise, scatter;
  };
  for (const double w020 : {0.0, 0.3}) {
    const Shot shot = shoot(square_at(7, 60), 240, 8, w020);
    double low = 0.05, high = 0.9;
    while (high - low > 1e-9) (shot.truth(0.5 * (low + high), 7) > 0.5 ? low : high) = 0.5 * (low + high);
    for (const Row& row : {Row{0.01, 0.0097}, {0.02, 0.017}, {0.05, 0.035}, {0.1, 0.07}}) {
      Plane noisy = shot.plane;
      std::mt19937 random(5);
      std::normal_distribution<double> normal(0, row.noise);
      for (double& value : noisy.values) value += normal(random);
      double error = 0;
      const FoundEdges found = find_edges(noisy);
      ASSERT_EQ(found.edges.size(), 4u) << row.noise;
      for (const FoundEdge& edge : found.edges) {
        SfrOptions options;
        options.missing_target = MissingTarget::where_sampled(edge);
        const EdgeMeasurement m = measure_edge(samples_about(shot.plane, edge), 1, options);
        error += 0.25 * (m.mtf50().frequency_cpp / low - 1);
        // As much as noise allows: a twentieth of the length is left out at either end.
        if (row.noise == 0.02) {
          EXPECT_GT(edge.sampled_to - edge.sampled_from, 0.9 * 60);
        }
      }
      EXPECT_LT(std::abs(error), 0.1 * row.scatter) << w020 << ' ' << row.noise;
    }
  }
}

TEST(FindEdges, SidesOfATriangleAreFoundInNoise) {
  // Acute corners are rounded by smoothing much more than square ones.
  TargetScene scene;
  scene.polygons.push_back({{{{23, 146}, {172, 206}, {150, 46}}}, 0, 0});
  const Shot shot = shoot(scene, 240, 8, 0.5);
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Plane noisy = shot.plane;
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, 1);
    for (double& value : noisy.values) value += (0.02 + 0.12 * value) * normal(random);
    EXPECT_EQ(find_edges(noisy).edges.size(), 3u) << seed;
  }
}

constexpr double rim_x = 60.3, rim_y = 59.8, rim_cos = 0.9925, rim_sin = 0.1222;

/// A disc whose rim passes through the middle at 7 degrees, with a Gaussian blur of one pixel.
Plane noisy_disc(double radius_px, double noise, unsigned seed) {
  constexpr int size = 120;
  Plane plane{size, size, {}};
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, noise);
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column) {
      const double inside = radius_px - std::hypot(column + 0.5 - rim_x + radius_px * rim_cos,
                                                   row + 0.5 - rim_y + radius_px * rim_sin);
      plane.values.push_back(0.5 * std::erfc(-inside / std::sqrt(2)) + normal(random));
    }
  return plane;
}

/// What a stretch of the rim of such a disc measures that has been taken for an edge.
EdgeMeasurement measure_rim(double radius_px, double half_length, double noise, unsigned seed) {
  FoundEdge edge;
  edge.from = {rim_x + half_length * rim_sin, rim_y - half_length * rim_cos};
  edge.to = {rim_x - half_length * rim_sin, rim_y + half_length * rim_cos};
  edge.reach_dark_px = edge.reach_bright_px = 15;
  edge.sampled_from = -half_length + 2, edge.sampled_to = half_length - 2;
  SfrOptions options;
  options.least_radius_px = EdgeSearchOptions().least_radius_px();
  options.start = edge.line();
  return measure_edge(samples_about(noisy_disc(radius_px, noise, seed), edge), 1, options);
}

TEST(FindEdges, ArcsAreToldFromStraightAndBentEdgesInNoise) {
  // The chord of the shortest edge leaves an arc of 150 pixels by 0.75, which is what outlines may.
  EXPECT_EQ(EdgeSearchOptions().least_radius_px(), 150);
  for (const double noise : {0.02, 0.1})
    for (unsigned seed = 1; seed <= 40; ++seed) {
      for (const double radius : {25, 40, 60})
        EXPECT_THROW(measure_rim(radius, 15, noise, seed), InputError)
            << radius << ' ' << noise << ' ' << seed;
      // The bend of a lens, and next to none.
      for (const double radius : {1e3, 1e6})
        EXPECT_NO_THROW(measure_rim(radius, 30, noise, seed)) << radius << ' ' << noise << ' ' << seed;
    }
}

TEST(FindEdges, WhatIsMissingFromAHalfPlaneIsAnAreaIntegral) {
  // Far beyond the edge on the bright side of a square 100 px wide, against a sum over cells of 1/9 px².
  const Shot shot = shoot(square_at(0), 240, 8);
  const FoundEdges found = find_edges(shot.plane);
  const FoundEdge* right = nullptr;
  for (const FoundEdge& edge : found.edges)
    if (std::min(edge.from.x, edge.to.x) > 169) right = &edge;
  ASSERT_NE(right, nullptr);
  const double x = 195, y = 120;
  double sum = 0;
  constexpr double cell = 1.0 / 3;
  for (double py = -880 + cell / 2; py < 1120; py += cell)
    for (double px = -880 + cell / 2; px < 170; px += cell)
      if (!(px > 70 && std::abs(py - 120) < 50))
        sum += cell * cell * std::pow(std::hypot(px - x, py - y), -3);
  // Beyond the half square of 1000 px lie another ∮ (x·n)/r³ ds = 2√2/1000; the outline found is good to some
  // hundredths of a pixel, and so is the field to 1 %.
  EXPECT_NEAR(MissingTarget::everywhere(*right)(x, y), sum + 2 * std::sqrt(2.0) / 1000, 3e-4);
}

TEST(FindEdges, ChartsAndBlur) {
  EXPECT_EQ(find_edges(shoot(test_chart("slanted-edges", 480, 480), 480, 8).plane).edges.size(), 36u);
  EXPECT_GE(find_edges(shoot(test_chart("slanted-star", 480, 480), 480, 8).plane).edges.size(), 20u);
  // A blur disc of 37 pixels about a square of 140.
  TargetScene scene;
  scene.polygons.push_back({{rectangle({160, 160}, 140, 140, 5)}, 0, 0});
  EXPECT_GE(find_edges(shoot(scene, 320, 4, 10).plane).edges.size(), 4u);
}

/// Squares of a checkerboard, corner to corner.
TargetScene checkerboard(double side, double angle_deg, int size) {
  TargetScene scene;
  const double c = std::cos(angle_deg * M_PI / 180), s = std::sin(angle_deg * M_PI / 180);
  const int reach = static_cast<int>(size / side) + 1;
  for (int i = -reach; i <= reach; ++i)
    for (int j = -reach; j <= reach; ++j)
      if ((i + j) % 2 == 0)
        scene.polygons.push_back(
            {{rectangle({0.5 * size + side * (i * c - j * s) + 3, 0.5 * size + side * (i * s + j * c) - 5},
                        side, side, angle_deg)},
             0,
             0});
  return scene;
}

TEST(FindEdges, WhereSquaresMeetNoSideGoesOnIntoTheNext) {
  // At a crossing a contour turns into the next square's side, from one rim of the picture to the other:
  // every edge is one side of a square, and is measured to 5e-4 as other edges are, but for those of the
  // outermost squares, about which nothing tells how the board goes on.
  constexpr double side = 70;
  const Shot shot = shoot(checkerboard(side, 4, 560), 560, 8);
  const FoundEdges found = find_edges(shot.plane);
  EXPECT_GE(found.edges.size(), 90u);
  for (const FoundEdge& edge : found.edges) {
    EXPECT_LT(edge.length_px(), side + 2);
    const double direction = std::atan2(edge.to.y - edge.from.y, edge.to.x - edge.from.x) * 180 / M_PI;
    EXPECT_NEAR(std::remainder(direction - 4, 90), 0, 3);
    SfrOptions options;
    options.missing_target = MissingTarget::where_sampled(edge);
    const double x = 0.5 * (edge.from.x + edge.to.x), y = 0.5 * (edge.from.y + edge.to.y);
    const double rim = std::min({x, y, shot.plane.columns - x, shot.plane.rows - y});
    EXPECT_LT(worst_error(shot, measure_edge(samples_about(shot.plane, edge), 1, options)),
              rim > side ? 5e-4 : 5e-3)
        << edge.from.x << "," << edge.from.y << " to " << edge.to.x << "," << edge.to.y;
  }
}

TEST(FindEdges, SaysSoWhereThereIsNone) {
  Plane flat{100, 100, std::vector<double>(10000, 0.5)};
  EXPECT_THROW(find_edges(flat), InputError);
  for (std::size_t i = 0; i < flat.values.size(); ++i) flat.values[i] = (i * 2654435761u % 1000) / 1000.0;
  EXPECT_THROW(find_edges(flat), InputError) << "noise";
  EXPECT_THROW(find_edges(Plane{1, 1, {0.5}}), InputError);
}

}  // namespace
}  // namespace petzval
