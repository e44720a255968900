// SPDX-License-Identifier: BSD-3-Clause
// Media of varying density against the integral along a ray, and against media without a grid.
#include <gtest/gtest.h>

#include "media_scenes.h"

namespace petzval::render {
namespace {

TEST(DensityGrid, LiesBetweenItsSamples) {
  const DensityGrid linear({2, 3, 1}, {0, 1, 2, 3, 4, 5}, {0, 0, 0}, {2, 3, 1},
                           Transform::scaling({10, 10, 10}));
  EXPECT_NEAR(linear.at({5, 5, 5}), 0, 1e-12);
  EXPECT_NEAR(linear.at({15, 5, 5}), 1, 1e-12);
  EXPECT_NEAR(linear.at({10, 10, 5}), 1.5, 1e-12);
  EXPECT_NEAR(linear.at({10, 20, 7.5}), 3.5 * 0.75, 1e-12);  // half of the way to half a cell outside
  EXPECT_NEAR(linear.at({15, 25, 5}), 5, 1e-12);
  EXPECT_EQ(linear.at({15, 25, -0.1}), 0);
  EXPECT_EQ(linear.at({15, 30.1, 5}), 0);
  EXPECT_EQ(linear.greatest(), 5);
}

/// What comes through is exp(−∫ density dt), by any ray and for any bound.
TEST(DensityGrid, LetsThroughWhatTheIntegralSays) {
  std::vector<float> values;
  for (int i = 0; i < 20 * 7 * 5; ++i)
    values.push_back(static_cast<float>(hashed(1, static_cast<std::uint32_t>(i)) * 0x1p-32));
  const DensityGrid grid({20, 7, 5}, values, {-1, -1, -1}, {1, 1, 1},
                         Transform::rotation(30, {1, 2, 3}) * Transform::scaling({1, 2, 3}));
  for (const auto& [from, to] : {std::pair{Vector3{-5, 0.1, 0.2}, Vector3{5, -0.1, 0.1}},
                                 {Vector3{0, 0.1, 0.3}, Vector3{0, 3, 5}},
                                 {Vector3{0.1, 0.2, 6}, Vector3{0.1, 0.2, -6}},
                                 {Vector3{9, 9, 9}, Vector3{9, -9, 9}}}) {
    const double distance = length(to - from);
    const Vector3 way = normalised(to - from);
    double depth = 0;
    constexpr int steps = 20000;
    for (int i = 0; i < steps; ++i)
      depth += distance / steps * grid.at(from + (i + 0.5) / steps * distance * way);
    constexpr int walks = 1 << 14;
    double through = 0, stopped = 0, squares = 0;
    for (int i = 0; i < walks; ++i) {
      Lots lots((i + 0.5) / walks), others((i + 0.5) / walks);
      const double survived = grid.walk(from, way, distance, 0.7, false, lots).survived;
      through += survived / walks, squares += survived * survived / walks;
      if (grid.walk(from, way, distance, 0.7, true, others).stopped_at) stopped += 1.0 / walks;
    }
    const double expected = std::exp(-0.7 * depth),
                 deviation = std::sqrt((squares - through * through) / walks);
    EXPECT_NEAR(through, expected, 4.5 * deviation + 1e-9);
    EXPECT_NEAR(stopped, 1 - expected, 4.5 * 0.5 / std::sqrt(walks));
  }
}

TEST(Media, AreTheSameInAGridThatIsEven) {
  const auto scene = [&](const std::string& fog) {
    return "LightSource \"point\" \"point3 from\" [ 1 2 0 ] \"spectrum I\" [ 300 9 900 9 ]\nLightSource "
           "\"infinite\" "
           "\"spectrum L\" [ 300 .3 900 .3 ]\n" +
           fog + fog_inside +
           "Shape \"sphere\" \"float radius\" 1\nMediumInterface \"fog\" \"fog\"\nMaterial "
           "\"diffuse\"\nTranslate 0 0 "
           "-.5\nShape \"sphere\" \"float radius\" 0.4\n";
  };
  const std::string coefficients = coloured("sigma_a", 0.05, 0.3, 1) + coloured("sigma_s", 0.3, 2, 1.2);
  const auto even = world_of(scene(medium(coefficients, 0.5))),
             gridded = world_of(scene(grid(5, 1, coefficients, 0.5)));
  // The same where half of the collisions are not real: one sample outside of the ball is denser.
  const auto bounded = world_of(
      scene(grid(20, 2, coefficients, 0.5, [](int x, int y, int z) { return x + y + z ? 1.0 : 4.0; })));
  for (const double y : {0.3, 0.8})
    for (const auto lights : {PathOptions::Lights::both, PathOptions::Lights::by_chance}) {
      const Estimate expected = seen(*even, {0, y, -5}, {0, 0, 1}, 1 << 14);
      for (const World* world : {gridded.get(), bounded.get()}) {
        const Estimate found = seen(*world, {0, y, -5}, {0, 0, 1}, 1 << 14, lights);
        for (std::size_t i = 0; i < 3; ++i)
          EXPECT_NEAR(found.mean[i], expected.mean[i],
                      4.5 * std::hypot(found.deviation[i], expected.deviation[i]))
              << i;
      }
    }
}

/// The furnace again, in a cloud of holes and lumps, which absorbs nothing; and one that only absorbs.
TEST(Media, KeepTheLightInAGrid) {
  const auto lumps = [](int x, int y, int z) { return (x + y + z) % 2 ? 0.0 : 2.0; };
  for (const char* boundary : {fog_inside, glass_about_fog})
    for (const auto lights :
         {PathOptions::Lights::both, PathOptions::Lights::by_chance, PathOptions::Lights::sampled}) {
      const auto world =
          world_of(std::string(white_furnace) +
                   grid(6, 1, flat("sigma_a", 0) + coloured("sigma_s", 0.5, 2, 6), 0.5, lumps) + boundary +
                   "Shape \"sphere\" \"float radius\" 1\n");
      const Estimate found = seen(*world, {0, 0.3, -5}, {0, 0, 1}, 1 << 12, lights);
      for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(found.mean[i], 1, 4.5 * found.deviation[i] + 1e-4) << boundary;
    }
  const auto dark = world_of(std::string(white_furnace) +
                             grid(5, 1, coloured("sigma_a", 0.1, 0.5, 2) + flat("sigma_s", 0), 0) +
                             fog_inside + "Shape \"sphere\" \"float radius\" 1\n");
  const Estimate found = seen(*dark, {0, 0, -5}, {0, 0, 1}, 1 << 14);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(found.mean[i], std::exp(-2 * std::array{0.1, 0.5, 2.0}[i]), 4.5 * found.deviation[i]) << i;
}

TEST(Media, RefusesWhatIsNoGrid) {
  const auto with = [](const std::string& parameters) {
    return media_message("MakeNamedMedium \"a\" \"string type\" \"uniformgrid\"\n" + parameters);
  };
  EXPECT_EQ(with("\"integer nx\" 2"), "test.pbrt:3:1: a uniformgrid needs \"float density\", its samples");
  EXPECT_EQ(with("\"integer nx\" 2 \"integer ny\" 2 \"float density\" [ 1 2 3 ]"),
            "test.pbrt:4:31: 3 samples of the density; nx × ny × nz = 2 x 2 x 1 would be right");
  EXPECT_EQ(with("\"float density\" 1 \"integer nx\" 0"), "test.pbrt:4:19: 1 or more would be right");
  EXPECT_EQ(with("\"float density\" -1"), "test.pbrt:4:1: a density of -1; 0 to 1e+12 would be right");
  EXPECT_EQ(with("\"point3 p1\" [ 0 1 1 ] \"float density\" 1"),
            "test.pbrt:4:1: a box without volume; p0 and p1 are opposite corners of it");
  EXPECT_EQ(with("\"float density\" 1e9"),
            "test.pbrt:3:1: 3.4641e+09 mean free paths across this medium; up to 100000 would be right");
  EXPECT_NE(with("\"rgb density\" [ 1 1 1 ]").find("test.pbrt:4:1: a density in colours"), std::string::npos);
  EXPECT_EQ(with("\"float density\" 1"), "nothing");
}

}  // namespace
}  // namespace petzval::render
