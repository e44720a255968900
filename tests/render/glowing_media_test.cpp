// SPDX-License-Identifier: BSD-3-Clause
// Media that shine against the equation of transfer in closed form, Kirchhoff's and Planck's laws, furnaces.
#include <gtest/gtest.h>
#include <petzval/colour/illuminants.h>
#include <petzval/render/lights/alter_lights.h>

#include "media_scenes.h"

namespace petzval::render {
namespace {

constexpr std::array<double, 3> absorbed{0.1, 0.5, 2}, scattered{0.3, 0.2, 0.6}, sent{3, 1, 0.5};
const std::string shining =
    coloured("sigma_a", absorbed[0], absorbed[1], absorbed[2]) + coloured("Le", sent[0], sent[1], sent[2]);

/// Within 4.5 deviations, and where rays meet surfaces by floats.
void expect_seen(const Estimate& found, const std::array<double, 3>& expected) {
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(found.mean[i], expected[i], 4.5 * found.deviation[i] + 1e-5 * expected[i]) << i;
}

TEST(GlowingMedia, ShineByTheEquationOfTransfer) {
  for (const bool scatters : {false, true}) {
    const std::string fog = medium(
        shining + "\"float Lescale\" 2 " +
        (scatters ? coloured("sigma_s", scattered[0], scattered[1], scattered[2]) : flat("sigma_s", 0)));
    const auto expected = [&](double way) {
      std::array<double, 3> light;
      for (std::size_t i = 0; i < 3; ++i) {
        const double all = absorbed[i] + (scatters ? scattered[i] : 0);
        light[i] = 2 * sent[i] * absorbed[i] / all * (1 - std::exp(-all * way));
      }
      return light;
    };
    // What has been scattered by nothing.
    const auto slab_of_it = world_of(fog + fog_inside + slab(1.5));
    expect_seen(seen(*slab_of_it, {0, 0, 5}, {0, 0, -1}, 8, PathOptions::Lights::both, 0), expected(1.5));
    expect_seen(seen(*slab_of_it, {0, 0, 5}, {3, 0, -4}, 8, PathOptions::Lights::both, 0),
                expected(1.5 / 0.8));
    const auto ball = world_of(fog + fog_inside + "Shape \"sphere\" \"float radius\" 2\n");
    expect_seen(seen(*ball, {0, 1, 5}, {0, 0, -1}, 8, PathOptions::Lights::both, 0),
                expected(2 * std::sqrt(3.0)));
    expect_seen(seen(*ball, {0, 3, -4}, {0, -0.6, 0.8}, 8, PathOptions::Lights::both, 0), expected(4));
  }
}

TEST(GlowingMedia, OfTheRadianceOfTheWallsAreNotSeen) {
  const auto lumps = [](int x, int y, int z) { return (x + y + z) % 2 ? 0.0 : 2.0; };
  const std::string coefficients =
      coloured("sigma_a", 0.2, 0.5, 3) + coloured("sigma_s", 0.5, 2, 1) + flat("Le", 1);
  std::string ones;
  for (int i = 0; i < 6 * 6 * 6; ++i) ones += " 1";
  // Radiance in glass is n² times that outside (Kirchhoff, Clausius).
  const std::string in_glass = coloured("sigma_a", 0.2, 0.5, 3) + flat("sigma_s", 1) + flat("Le", 2.25);
  for (const auto& [fog, boundary] : {std::pair{medium(coefficients, 0.6), fog_inside},
                                      {medium(in_glass, 0.6), glass_about_fog},
                                      {grid(6, 1, coefficients, 0.6, lumps), fog_inside}}) {
    const auto world =
        world_of(std::string(white_furnace) + fog + boundary + "Shape \"sphere\" \"float radius\" 1\n");
    for (const auto lights :
         {PathOptions::Lights::both, PathOptions::Lights::by_chance, PathOptions::Lights::sampled})
      expect_seen(seen(*world, {0, 0.3, -5}, {0, 0, 1}, 1 << 12, lights), {1, 1, 1});
  }
}

TEST(GlowingMedia, LeaveGlassThatDisperses) {
  // So thick that one sees its radiance, straight on: what the boundary lets through, over n².
  const auto world = world_of(medium(flat("sigma_a", 1e6) + flat("sigma_s", 0) + flat("Le", 1)) +
                              "MediumInterface \"fog\" \"\"\nMaterial \"dielectric\" \"spectrum eta\" [ 450 "
                              "1.7 550 1.5 650 1.4 ]\n" +
                              slab(1));
  std::array<double, 3> expected;
  for (std::size_t i = 0; i < 3; ++i) {
    const double n = std::array{1.7, 1.5, 1.4}[i], r = (n - 1) / (n + 1);
    expected[i] = (1 - r * r) / (n * n);
  }
  expect_seen(seen(*world, {0, 0, 5}, {0, 0, -1}, 3 << 12), expected);
}

TEST(GlowingMedia, ShineInAGridByTheIntegralAlongTheRay) {
  constexpr int n = 5;
  const auto density = [](int x, int y, int z) { return 0.5 * ((3 * x + 5 * y + 7 * z) % 4); };
  std::string strengths = "\"float Lescale\" [";
  std::vector<float> dense, strong;
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        dense.push_back(static_cast<float>(density(x, y, z)));
        strong.push_back(static_cast<float>((5 * x + y + 2 * z) % 3));
        strengths += " " + std::to_string(strong.back());
      }
  const double edge = n / (n - 1.0);
  const DensityGrid densities({n, n, n}, dense, {-edge, -edge, -edge}, {edge, edge, edge}, Transform()),
      times({n, n, n}, strong, {-edge, -edge, -edge}, {edge, edge, edge}, Transform());
  for (const double thickness : {0.01, 1.0, 5.0})
    for (const bool scatters : {false, true}) {
      const std::string scale = "\"float scale\" " + std::to_string(thickness) + " ";
      const auto world =
          world_of(grid(n, 1,
                        shining + scale + strengths + " ] " +
                            (scatters ? coloured("sigma_s", scattered[0], scattered[1], scattered[2])
                                      : flat("sigma_s", 0)),
                        0, density) +
                   fog_inside + "Shape \"sphere\" \"float radius\" 3\n");
      const Vector3 from{-4, 0.3, 0.2}, way = normalised({1, 0.05, -0.1});
      std::array<double, 3> expected{}, depth{};
      constexpr int steps = 20000;
      for (int step = 0; step < steps; ++step) {
        const Vector3 at = from + (step + 0.5) / steps * 8 * way;
        for (std::size_t i = 0; i < 3; ++i) {
          const double each = thickness * 8.0 / steps * densities.at(at);
          const double all = absorbed[i] + (scatters ? scattered[i] : 0);
          expected[i] += sent[i] * times.at(at) * absorbed[i] * each * std::exp(-depth[i] - all * each / 2);
          depth[i] += all * each;
        }
      }
      const Estimate found = seen(*world, from, way, 1 << 12, PathOptions::Lights::both, 0);
      expect_seen(found, expected);
      // Thin media are quiet, too.
      EXPECT_LT(found.deviation[0] * std::sqrt(1 << 12), expected[0]);
    }
}

TEST(GlowingMedia, ByTemperatureAreBlackBodies) {
  constexpr double kelvin = 1800;
  std::string temperatures = "\"float temperature\" [";
  for (int i = 0; i < 27; ++i) temperatures += " 90.5";
  // (90.5 − 0.5) · 20 K; half of the strength.
  std::string strengths = "\"float Lescale\" [";
  for (int i = 0; i < 27; ++i) strengths += " 0.5";
  const std::string fog = grid(3, 1,
                               flat("sigma_a", 500) + flat("sigma_s", 0) + temperatures + " ] " + strengths +
                                   " ] \"float temperatureoffset\" 0.5 \"float temperaturescale\" 20 ",
                               0);
  const auto world = world_of(fog + fog_inside + "Shape \"sphere\" \"float radius\" 1\n");
  double strongest = 0;  // over wavelengths, found by trying
  for (double nm = 1000; nm < 2500; nm += 0.5)
    strongest = std::max(strongest, blackbody_radiance(nm, kelvin));
  const Estimate found = seen(*world, {-3, 0, -4}, {0.6, 0, 0.8}, 1 << 14);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(
        found.mean[i] / (0.5 * blackbody_radiance(450 + 100.0 * static_cast<double>(i), kelvin) / strongest),
        1, 0.01);
  // Below 100 K they are dark.
  const auto cold = world_of(grid(3, 1, flat("sigma_a", 500) + flat("sigma_s", 0) + temperatures + " ] ", 0) +
                             fog_inside + "Shape \"sphere\" \"float radius\" 1\n");
  expect_seen(seen(*cold, {-3, 0, -4}, {0.6, 0, 0.8}, 8), {0, 0, 0});
}

const std::string lamp_and_fire =
    "LightSource \"point\" \"point3 from\" [ 3 0 0 ] \"spectrum I\" [ 300 5 900 5 ]\n" +
    medium(shining + coloured("sigma_s", 1, 2, 0.5), 0.4) + fog_inside +
    "Shape \"sphere\" \"float radius\" 1\n";

TEST(GlowingMedia, AreALightOfTheSceneWithAGroupOfItsOwn) {
  const auto world = world_of(lamp_and_fire);
  ASSERT_EQ(world->lights.sources, (std::vector<std::string>{"0 point", "1 medium fog"}));
  const PathTracer tracer(*world, {});
  std::array<double, 3> fire{};
  constexpr int samples = 1 << 12;
  for (int i = 0; i < samples; ++i) {
    SobolSample sample(5, static_cast<std::uint32_t>(i));
    std::array<SourceLight, 2> of;
    const PathLight all = tracer.trace({0, 0.2, 5}, {0, 0, -1}, 0, i % 3, sample,
                                       std::numeric_limits<double>::infinity(), nullptr, of);
    for (int lane = 0; lane < 3; ++lane) {
      EXPECT_NEAR(of[0].shared[lane] + of[1].shared[lane], all.shared[lane], 1e-5f * (1 + all.shared[lane]));
      fire[static_cast<std::size_t>(lane)] += static_cast<double>(of[1].shared[lane]) / samples;
    }
  }
  const auto alone = world_of(lamp_and_fire.substr(lamp_and_fire.find('\n') + 1));
  EXPECT_FALSE(alone->is_dark());
  const Estimate expected = seen(*alone, {0, 0.2, 5}, {0, 0, -1}, samples, PathOptions::Lights::both, 5);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(fire[i], expected.mean[i], 6 * expected.deviation[i]);
}

TEST(GlowingMedia, AreAlteredAsOtherLights) {
  const auto altered = [](const std::string& text, const char* change) {
    SceneDescription scene = described(text);
    const std::array changes{parse_light_change(change)};
    alter_lights(changes, scene);
    Unsupported unsupported;
    return build_world(scene, WavelengthGroups({450, 550, 650}), {true}, unsupported);
  };
  const auto before = world_of(lamp_and_fire), strong = altered(lamp_and_fire, "scale@1=3"),
             warm = altered(lamp_and_fire, "kelvin@1=2500");
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(strong->media[0].emission->radiance[0][i], 3 * before->media[0].emission->radiance[0][i],
                1e-5f);
    EXPECT_NEAR(static_cast<double>(warm->media[0].emission->radiance[0][i] /
                                    warm->media[0].emission->radiance[0][0]),
                blackbody_radiance(450 + 100 * i, 2500) / blackbody_radiance(450, 2500), 1e-4);
  }
  EXPECT_EQ(altered(lamp_and_fire, "scale@1=0")->media[0].emission, nullptr);
  try {
    altered(lamp_and_fire, "turn_deg@1=20");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("is a medium that shines"), std::string::npos);
  }
}

TEST(GlowingMedia, RefuseWhatIsNoLight) {
  const auto with = [](const char* type, const std::string& parameters) {
    return media_message("MakeNamedMedium \"a\" \"string type\" \"" + std::string(type) + "\"\n" +
                         parameters);
  };
  EXPECT_EQ(with("homogeneous", "\"float Lescale\" -1 \"rgb Le\" [ 1 1 1 ]"),
            "test.pbrt:4:1: a scale of light of -1; 0 to 1e+12 would be right");
  EXPECT_EQ(with("homogeneous", "\"spectrum Le\" [ 400 -1 700 -1 ]"),
            "test.pbrt:4:1: a light of -1 at 450 nm; 0 to 1e+20 would be right");
  EXPECT_NE(with("homogeneous", "\"float temperature\" 300").find("4:1: the parameter \"float temperature\""),
            std::string::npos);
  const std::string two = "\"integer nx\" 2 \"float density\" [ 1 1 ] ";
  EXPECT_EQ(with("uniformgrid", two + "\"float Lescale\" [ 1 1 1 ] \"rgb Le\" [ 1 1 1 ]"),
            "test.pbrt:4:40: 3 samples of the scale of light; nx × ny × nz = 2 x 1 x 1 would be right");
  EXPECT_EQ(with("uniformgrid", two + "\"float temperature\" [ 1 -1 ]"),
            "test.pbrt:4:40: a temperature of -1; 0 to 1e+12 would be right");
  EXPECT_EQ(with("uniformgrid", two + "\"float temperature\" [ 1 1 ] \"rgb Le\" [ 1 1 1 ]"),
            "test.pbrt:4:68: a medium shines either by \"Le\" or by \"temperature\"");
  EXPECT_EQ(with("uniformgrid", two + "\"rgb Le\" [ 0 0 0 ]"), "nothing");
  EXPECT_EQ(with("homogeneous", "\"blackbody Le\" 2000 \"float Lescale\" 3"), "nothing");
}

}  // namespace
}  // namespace petzval::render
