// SPDX-License-Identifier: BSD-3-Clause
// Lights that shine by a picture: where each pixel goes, how much light that is, and what is refused.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/scratch_folder.h>
#include <petzval/base/units.h>
#include <petzval/colour/observer.h>

#include <cmath>
#include <fstream>

#include "scene_text.h"

namespace petzval::render {
namespace {

/// Pictures of numbers as they stand, in a folder that scenes name.
class LightPattern : public testing::Test {
 protected:
  /// Rows of red, green and blue, from the top, as a flat Radiance picture.
  std::string picture(const std::string& name, int width, int height,
                      const std::vector<std::array<double, 3>>& pixels) {
    const std::string path = folder_.path() + "/" + name;
    std::ofstream file(path, std::ios::binary);
    file << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " << height << " +X " << width << "\n";
    for (const auto& rgb : pixels) {
      const double most = std::max({rgb[0], rgb[1], rgb[2]});
      int exponent = 0;
      if (most > 0) std::frexp(most, &exponent);
      for (const double each : rgb)
        file.put(static_cast<char>(most > 0 ? std::lround(std::ldexp(each, 8 - exponent)) : 0));
      file.put(static_cast<char>(most > 0 ? exponent + 128 : 0));
    }
    return path;
  }

  /// A slide of two columns and one row: left 0.5, right 2.
  std::string slide() { return picture("slide.hdr", 2, 1, {{0.5, 0.5, 0.5}, {2, 2, 2}}); }

  ScratchFolder folder_;
};

/// ∫ ȳ of the light that arrives at a point from the only light of a world [per square unit].
double arriving(const World& world, Vector3 at) {
  const LightPlan plan = world.lights.plan({at, normalised(-at), true});
  const auto light = world.lights.sample(world.geometries, plan, 0.5, 0.5, 0.5, 0);
  return light ? static_cast<double>(light->light[0]) / light->pdf : 0;
}

/// Of one light that is as bright as its scale says, at one wavelength.
double strength_of(const std::string& text) {
  return arriving(*world_of(text + " \"spectrum I\" [ 300 1 900 1 ]", {550}), {0, 0, 1});
}

TEST_F(LightPattern, CastsASlideUprightAndNotMirrored) {
  // 90 degrees over the shorter side: 2 x 1 pixels reach from −2 to 2 and from −1 to 1 at distance 1.
  const auto world = world_of("LightSource \"projection\" \"string filename\" \"" + slide() + "\"", {550});
  const double right = arriving(*world, {1, 0, 1}) * 2, left = arriving(*world, {-1, 0, 1}) * 2;
  EXPECT_GT(left, 0);
  EXPECT_NEAR(right / left, 4, 1e-3);  // what the table of spectra is fitted to
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_GT(arriving(*world, {sign * 1.999, 0.999, 1}), 0);
    EXPECT_GT(arriving(*world, {sign * 1.999, -0.999, 1}), 0);
    EXPECT_EQ(arriving(*world, {sign * 2.001, 0, 1}), 0);
    EXPECT_EQ(arriving(*world, {0, sign * 1.001, 1}), 0);
  }
  EXPECT_EQ(arriving(*world, {0, 0, -1}), 0);  // behind
  // Rows: the first is above.
  const std::string tall = picture("tall.hdr", 1, 2, {{2, 2, 2}, {0.5, 0.5, 0.5}});
  const auto upright = world_of("LightSource \"projection\" \"string filename\" \"" + tall + "\"", {550});
  EXPECT_NEAR(arriving(*upright, {0, 1, 1}) / arriving(*upright, {0, -1, 1}), 4, 1e-3);
}

TEST_F(LightPattern, FallsWithTheSquareOfTheDistanceAndTurnsWithItsSpace) {
  const auto world = world_of(
      "Translate 1 2 3\nRotate 90 0 1 0\nScale 3 3 3\nLightSource \"projection\" "
      "\"string filename\" \"" +
          slide() + "\" \"float fov\" 60",
      {550});
  // Rotate 90 0 1 0 takes +z to +x, and +x to −z.
  const auto from_light = [&](Vector3 way) {
    const Vector3 at = Vector3{1, 2, 3} + way;
    const LightPlan plan = world->lights.plan({at, normalised(-way), true});
    const auto light = world->lights.sample(world->geometries, plan, 0.5, 0.5, 0.5, 0);
    return light ? static_cast<double>(light->light[0]) / light->pdf : 0.0;
  };
  EXPECT_GT(from_light({1, 0, -0.5}), from_light({1, 0, 0.5}) * 3.9);
  EXPECT_NEAR(from_light({2, 0, -1}) * 4, from_light({1, 0, -0.5}), 1e-6 * from_light({1, 0, -0.5}));
  EXPECT_EQ(from_light({-1, 0, 0}), 0);
}

/// Luminous power into all directions, by a rule of its own: even steps of height and azimuth.
double power_of(const std::string& light) {
  std::vector<double> nm;
  for (int each = 360; each <= 830; each += 10) nm.push_back(each);
  const auto world = world_of(light, nm);
  const std::vector<Xyz> weights = Observer::cie_1931().weights(nm);
  constexpr int steps = 200;
  double sum = 0;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < 2 * steps; ++j) {
      const double z = (2 * i + 1.0) / steps - 1, phi = 2 * pi * (j + 0.5) / (2 * steps);
      const double r = std::sqrt(1 - z * z);
      const Vector3 at{r * std::cos(phi), r * std::sin(phi), z};
      const LightPlan plan = world->lights.plan({at, -at, true});
      for (int group = 0; group < world->groups.count(); ++group) {
        const auto found = world->lights.sample(world->geometries, plan, 0.5, 0.5, 0.5, group);
        if (!found) continue;
        for (int lane = 0; lane < world->groups.lanes(group); ++lane)
          sum += static_cast<double>(found->light[lane]) / found->pdf *
                 weights[static_cast<std::size_t>(world->groups.band(group, lane))].y;
      }
    }
  return sum * 4 * pi / (steps * 2.0 * steps);
}

TEST_F(LightPattern, HasThePowerThatItIsAskedFor) {
  const std::string file = "\"string filename\" \"" + slide() + "\"";
  // The last per cent: edges of the slide in the rule of the test, and spectra that stand for colours.
  EXPECT_NEAR(power_of("LightSource \"projection\" \"float power\" 50 \"float fov\" 70 " + file), 50, 0.5);
  const std::string square =
      picture("square.hdr", 2, 2, {{1, 1, 1}, {0, 0, 0}, {0.25, 0.25, 0.25}, {2, 2, 2}});
  EXPECT_NEAR(
      power_of("LightSource \"goniometric\" \"float power\" 50 \"string filename\" \"" + square + "\""), 50,
      0.25);
}

TEST_F(LightPattern, OfOneValueIsAPointLight) {
  const std::string even = picture("even.hdr", 1, 1, {{0.5, 0.5, 0.5}});
  const std::string of_file = "LightSource \"goniometric\" \"string filename\" \"" + even + "\"";
  const auto value = static_cast<double>(read_picture_file(even).values[0]);
  EXPECT_NEAR(value, 0.5, 0.004);  // digits of eight bits
  EXPECT_NEAR(strength_of(of_file), value * strength_of("LightSource \"point\""), 1e-7);
  EXPECT_NEAR(strength_of("LightSource \"goniometric\""), strength_of("LightSource \"point\""), 1e-7);
}

TEST_F(LightPattern, HasItsPoleAlongY) {
  // The middle of the octahedral square is the pole; its corners are the other pole.
  std::vector<std::array<double, 3>> pixels(16 * 16, {0, 0, 0});
  for (int row = 6; row < 10; ++row)
    for (int column = 6; column < 10; ++column)
      pixels[static_cast<std::size_t>(16 * row + column)] = {1, 1, 1};
  const auto world = world_of(
      "LightSource \"goniometric\" \"string filename\" \"" + picture("pole.hdr", 16, 16, pixels) + "\"",
      {550});
  EXPECT_GT(arriving(*world, {0, 1, 0}), 0);
  for (const Vector3 dark : {Vector3{0, -1, 0}, Vector3{1, 0, 0}, Vector3{0, 0, 1}, Vector3{0, 0, -1}})
    EXPECT_EQ(arriving(*world, dark), 0);
}

TEST_F(LightPattern, RefusesWhatItCannotShineBy) {
  const auto message = [](const std::string& text) -> std::string {
    try {
      world_of(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const auto says = [&](const std::string& text, const std::string& part) {
    EXPECT_NE(message(text).find(part), std::string::npos) << message(text);
  };
  says("LightSource \"projection\"", "test.pbrt:3:1: a projection light needs \"string filename\"");
  says("LightSource \"projection\" \"string filename\" \"absent.png\"", "absent.png");
  says("LightSource \"projection\" \"float fov\" 180 \"string filename\" \"" + slide() + "\"",
       "above 0 and below 180 would be right");
  says("LightSource \"goniometric\" \"string filename\" \"" + slide() + "\"",
       "has 2 x 1 pixels; a square picture in the equal-area octahedral layout would be right");
}

}  // namespace
}  // namespace petzval::render
