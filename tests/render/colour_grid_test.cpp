// SPDX-License-Identifier: BSD-3-Clause
// Media in colours from place to place against media of one colour, integrals along rays, furnaces.
#include <gtest/gtest.h>

#include "media_scenes.h"

namespace petzval::render {
namespace {

using Colour = std::array<double, 3>;
using ColourAt = std::function<Colour(int, int, int)>;

std::string colours(const char* name, int n, const ColourAt& of) {
  std::string text = std::string("\"rgb ") + name + "\" [";
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x)
        for (const double each : of(x, y, z)) text += " " + std::to_string(each);
  return text + " ] ";
}

/// As grid(): n samples an edge in a box that is even from −half to half if they are.
std::string colour_grid(int n, double half, const std::string& parameters) {
  const std::string edge = std::to_string(half * n / (n - 1)), cells = std::to_string(n);
  return "MakeNamedMedium \"fog\" \"string type\" \"rgbgrid\" " + parameters + "\"point3 p0\" [ -" + edge +
         " -" + edge + " -" + edge + " ] \"point3 p1\" [ " + edge + " " + edge + " " + edge +
         " ] \"integer nx\" " + cells + " \"integer ny\" " + cells + " \"integer nz\" " + cells + "\n";
}

const std::string coloured_ball = fog_inside + std::string("Shape \"sphere\" \"float radius\" 1\n");

void expect_alike(const Estimate& found, const Estimate& expected) {
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(found.mean[i], expected.mean[i],
                4.5 * std::hypot(found.deviation[i], expected.deviation[i]) + 1e-5)
        << i;
}

TEST(ColourGrid, OfOneColourIsAMediumOfIt) {
  const std::string lit = "LightSource \"point\" \"point3 from\" [ 1 2 0 ] \"spectrum I\" [ 300 9 900 9 ]\n" +
                          std::string("LightSource \"infinite\" \"spectrum L\" [ 300 .3 900 .3 ]\n");
  const auto even = world_of(
      lit + medium("\"rgb sigma_a\" [ .1 .4 .9 ] \"rgb sigma_s\" [ 2 .5 .2 ] \"float scale\" 2 ", 0.5) +
      coloured_ball);
  // One sample outside of the ball is denser, so that most collisions are not real.
  const auto lump = [](Colour colour) {
    return [colour](int x, int y, int z) {
      const double times = x + y + z ? 1 : 4;
      return Colour{times * colour[0], times * colour[1], times * colour[2]};
    };
  };
  const auto gridded = world_of(lit +
                                colour_grid(12, 2,
                                            colours("sigma_a", 12, lump({0.1, 0.4, 0.9})) +
                                                colours("sigma_s", 12, lump({2, 0.5, 0.2})) +
                                                "\"float scale\" 2 \"float g\" 0.5 ") +
                                coloured_ball);
  for (const auto lights :
       {PathOptions::Lights::both, PathOptions::Lights::by_chance, PathOptions::Lights::sampled})
    expect_alike(seen(*gridded, {0, 0.3, -5}, {0, 0, 1}, 1 << 13, lights),
                 seen(*even, {0, 0.3, -5}, {0, 0, 1}, 1 << 13));
}

TEST(ColourGrid, DimsByTheIntegralAlongTheRay) {
  constexpr int n = 4;
  const ColourAt of = [](int x, int y, int z) {
    return Colour{0.1 * ((x + 2 * y) % 3), 0.2 * ((y + z) % 4), 0.3 * ((x + z) % 2)};
  };
  std::vector<double> rgb;
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x)
        for (const double each : of(x, y, z)) rgb.push_back(each);
  const WavelengthGroups groups({450, 550, 650});
  const ColourSamples samples({n, n, n}, rgb, groups.sampled([](double) { return 1; }), groups);
  const auto world = world_of(
      std::string(white_furnace) +
      colour_grid(n, 1,
                  colours("sigma_a", n, of) + colours("sigma_s", n, [](int, int, int) { return Colour{}; })) +
      fog_inside + "Shape \"sphere\" \"float radius\" 3\n");
  const Vector3 from{-4, 0.3, 0.2}, way = normalised({1, 0.05, -0.1});
  std::array<double, 3> depth{};
  constexpr int steps = 10000;
  const double edge = n / (n - 1.0);
  for (int step = 0; step < steps; ++step) {
    const Vector3 at = 0.5 / edge * (from + (step + 0.5) / steps * 8 * way);
    const Lanes here = samples.at({at.x + 0.5, at.y + 0.5, at.z + 0.5}, 0);
    for (std::size_t i = 0; i < 3; ++i)
      depth[i] += 8.0 / steps * static_cast<double>(here[static_cast<int>(i)]);
  }
  const Estimate found = seen(*world, from, way, 1 << 13);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_GT(depth[i], 0.2);
    EXPECT_NEAR(found.mean[i], std::exp(-depth[i]), 4.5 * found.deviation[i]) << i;
  }
}

TEST(ColourGrid, OfTheRadianceOfTheWallsIsNotSeen) {
  // pbrt-v4's radiance of 1: D65 with the luminance of an even spectrum.
  const std::string walls = "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ] \"float scale\" 106.856895\n";
  const ColourAt absorbed = [](int x, int y, int z) {
    return Colour{1.0 * ((x + y) % 2), 2.0 * ((y + z) % 2), 0.5};
  };
  const ColourAt scattered = [](int x, int y, int z) {
    return Colour{1.5 * ((x + z) % 2), 0.3, 1.0 * ((x + y + z) % 3)};
  };
  const std::string coefficients = colours("sigma_a", 5, absorbed) + colours("sigma_s", 5, scattered);
  const auto world = world_of(walls +
                              colour_grid(5, 1.5,
                                          coefficients +
                                              colours("Le", 5,
                                                      [](int, int, int) {
                                                        return Colour{0.5, 0.5, 0.5};
                                                      }) +
                                              "\"float Lescale\" 2 \"float g\" 0.6 ") +
                              coloured_ball);
  const Estimate expected = seen(*world, {0, 3, -5}, {0, 0, 1}, 8);
  for (const auto lights :
       {PathOptions::Lights::both, PathOptions::Lights::by_chance, PathOptions::Lights::sampled})
    expect_alike(seen(*world, {0, 0.3, -5}, {0, 0, 1}, 1 << 13, lights), expected);
}

TEST(ColourGrid, RefusesWhatIsNone) {
  const auto with = [](const std::string& parameters) {
    return media_message("MakeNamedMedium \"a\" \"string type\" \"rgbgrid\"\n" + parameters);
  };
  EXPECT_EQ(with(""), "test.pbrt:3:1: a rgbgrid needs \"rgb sigma_a\" or \"rgb sigma_s\"");
  EXPECT_EQ(with("\"rgb sigma_a\" [ 1 1 1 ] \"integer nx\" 2"),
            "test.pbrt:4:1: 3 numbers of colours; 3 × nx × ny × nz = 3 x 2 x 1 x 1 would be right");
  EXPECT_EQ(with("\"rgb sigma_a\" [ 1 -1 1 ]"),
            "test.pbrt:4:1: a part of a colour of -1; 0 to 1e+12 would be right");
  EXPECT_NE(
      with("\"rgb sigma_s\" [ 1 1 1 ] \"rgb Le\" [ 1 1 1 ]").find("4:25: a medium in colours shines only"),
      std::string::npos);
  EXPECT_NE(with("\"rgb sigma_s\" [ 1e9 1 1 ]").find("mean free paths across"), std::string::npos);
  EXPECT_NE(with("\"rgb sigma_s\" [ 1 1 1 ] \"float density\" 1").find("4:25: the parameter"),
            std::string::npos);
  EXPECT_EQ(with("\"rgb sigma_s\" [ 1 1 1 ]"), "nothing");
}

}  // namespace
}  // namespace petzval::render
