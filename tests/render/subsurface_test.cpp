// SPDX-License-Identifier: BSD-3-Clause
// Subsurface materials against media with boundaries, and against the colours that they state.
#include <gtest/gtest.h>
#include <petzval/base/units.h>
#include <petzval/render/materials/fresnel.h>
#include <petzval/render/media/diffuse_albedo.h>
#include <petzval/render/media/varied_medium.h>

#include <array>
#include <cmath>

#include "media_scenes.h"

namespace petzval::render {
namespace {

/// pbrt-v4's material is a boundary and a medium.
TEST(Subsurface, IsABoundaryAndAMedium) {
  const std::string coefficients = coloured("sigma_a", 0.05, 0.3, 1) + coloured("sigma_s", 3, 2, 1.2);
  const std::string ball = "Shape \"sphere\" \"float radius\" 1\n",
                    rough = "\"float roughness\" 0.1 \"float eta\" 1.4 ";
  const auto two = world_of(white_furnace + medium(coefficients, 0.3) +
                            "MediumInterface \"fog\" \"\"\nMaterial \"dielectric\" " + rough + "\n" + ball),
             one = world_of(white_furnace + ("Material \"subsurface\" " + rough + "\"float g\" 0.3 ") +
                            coefficients + "\n" + ball);
  const Estimate expected = seen(*two, {0, 0.3, -5}, {0, 0, 1}, 1 << 10),
                 found = seen(*one, {0, 0.3, -5}, {0, 0, 1}, 1 << 10);
  EXPECT_EQ(found.mean, expected.mean);
  EXPECT_LT(found.mean[2], 0.9);
  // Milk, 50 mean free paths thick: white, and a little yellow.
  const auto milk =
      world_of(std::string(white_furnace) + "Material \"subsurface\" \"float scale\" 10\n" + ball);
  const Estimate white = seen(*milk, {0, 0.3, -5}, {0, 0, 1}, 1 << 9);
  EXPECT_GT(white.mean[2], 0.85);
  EXPECT_LT(white.mean[2], 1);
  EXPECT_LT(white.mean[0], white.mean[2]);
}

/// Half spaces of stated colour in a white furnace: what the boundary reflects, and of the rest that colour.
/// A walk at random is the second method; with g, similarity is 6 % off where single scattering counts.
TEST(Subsurface, HasTheReflectanceThatItStates) {
  const std::array<double, 3> reflectance{0.2, 0.5, 0.85};
  for (const auto& [eta, g, bound] :
       {std::array{1.05, 0.0, 0.003}, std::array{1.5, 0.0, 0.003}, std::array{1.33, 0.6, 0.06}}) {
    const auto world =
        world_of(white_furnace + ("Material \"subsurface\" \"float eta\" " + std::to_string(eta)) +
                 " \"float g\" " + std::to_string(g) + flat(" mfp", 2) +
                 coloured("reflectance", reflectance[0], reflectance[1], reflectance[2]) +
                 "\nShape \"disk\" \"float radius\" 1e6\n");
    EXPECT_NEAR(static_cast<double>(world->media[0].extinction(0)[1]), 0.5, 1e-6);
    const Estimate found = seen(
        *world,
        [](double u, double v) {
          const double r = std::sqrt(u);
          return std::array{Vector3{0, 0, 0.1},
                            Vector3{r * std::cos(2 * pi * v), r * std::sin(2 * pi * v), -std::sqrt(1 - u)}};
        },
        1 << 14, PathOptions::Lights::both, 100000);
    const double mirrored = mean_dielectric_reflectance(eta);
    for (std::size_t i = 0; i < 3; ++i) {
      const double inner = (found.mean[i] - mirrored) / (1 - mirrored);
      EXPECT_NEAR(inner / reflectance[i], 1, bound + 4.5 * found.deviation[i] / reflectance[i])
          << eta << " " << g << " " << i;
      EXPECT_LT(found.deviation[i], 0.005);
    }
  }
  EXPECT_NEAR(diffuse_albedo(1, 1.33), 1, 1e-5);
  EXPECT_EQ(diffuse_albedo(0, 1.33), 0);
  EXPECT_EQ(scattering_albedo(1, 1.33, 0.5), 1);
  EXPECT_EQ(scattering_albedo(0, 1.33, 0.5), 0);
}

/// Light that enters in one square of a texture comes out as of a body that is like this all over.
TEST(Subsurface, VariesAsTheSurfaceAboveIt) {
  const std::string squares =
      "Texture \"a\" \"spectrum\" \"checkerboard\" \"spectrum tex1\" [ 300 0.1 900 0.3 ] \"spectrum tex2\" [ "
      "300 0.7 900 0.6 ] \"string mapping\" \"planar\" \"vector3 v1\" [ 1e-4 0 0 ] \"vector3 v2\" [ 0 1e-4 0 "
      "]\n"
      "Texture \"f\" \"float\" \"checkerboard\" \"float tex1\" 0.2 \"float tex2\" 0.6 \"string mapping\" "
      "\"planar\" \"vector3 v1\" [ 1e-4 0 0 ] \"vector3 v2\" [ 0 1e-4 0 ]\n";
  const auto seen_at = [&](const std::string& material, double x) {
    const auto world = world_of(white_furnace + squares + "Material \"subsurface\" " + material +
                                "\nShape \"disk\" \"float radius\" 1e6\n");
    return seen(*world, {x, 5000, 0.1}, {0.1, 0.2, -1}, 2000).mean;
  };
  const std::array<std::string, 2> colour{"[ 300 0.1 900 0.3 ] ", "[ 300 0.7 900 0.6 ] "},
      number{"0.2 ", "0.6 "};
  for (std::size_t i = 0; i < 2; ++i) {
    const double x = i == 0 ? 5000 : -5000;
    EXPECT_EQ(seen_at("\"texture sigma_a\" \"a\" \"rgb sigma_s\" [ 1 1 1 ]", x),
              seen_at("\"spectrum sigma_a\" " + colour[i] + "\"rgb sigma_s\" [ 1 1 1 ]", x));
    EXPECT_EQ(
        seen_at("\"texture sigma_s\" \"a\" \"texture g\" \"f\"" + flat(" sigma_a", 0.1), x),
        seen_at("\"spectrum sigma_s\" " + colour[i] + "\"float g\" " + number[i] + flat(" sigma_a", 0.1), x));
    const auto scaled = seen_at("\"string name\" \"Skin1\" \"texture scale\" \"f\"", x),
               named = seen_at("\"string name\" \"Skin1\" \"float scale\" " + number[i], x);
    const auto varied = seen_at("\"texture reflectance\" \"a\" \"texture mfp\" \"a\"", x),
               even = seen_at("\"spectrum reflectance\" " + colour[i] + "\"spectrum mfp\" " + colour[i], x);
    for (std::size_t lane = 0; lane < 3; ++lane) {
      EXPECT_NEAR(scaled[lane], named[lane], 1e-5);
      EXPECT_NEAR(varied[lane], even[lane], 4e-3);  // by tables: some of the walks end elsewhere
    }
  }
  EXPECT_NE(seen_at("\"texture sigma_s\" \"a\"", 5000), seen_at("\"texture sigma_s\" \"a\"", -5000));
  const AlbedoTable table(1.33);
  for (const double reflectance : {0.004, 0.1, 0.5, 0.93, 0.999})
    EXPECT_NEAR(table.scattering_albedo(reflectance, 0.4), scattering_albedo(reflectance, 1.33, 0.4), 2e-4);
}

TEST(Subsurface, RefusesWhatIsNone) {
  const auto with = [](const std::string& parameter) {
    return media_message("Material \"subsurface\"\n" + parameter + "\nShape \"sphere\"");
  };
  EXPECT_EQ(with("\"float g\" 1"), "test.pbrt:4:1: a mean cosine of 1; above -1 and below 1 would be right");
  EXPECT_EQ(with("\"rgb mfp\" [ 1 2 3 ]"),
            "test.pbrt:4:1: a mean free path without a \"reflectance\" is not supported (`list_unsupported` "
            "shows all "
            "such things)");
  EXPECT_NE(with("\"string name\" \"Tea\"").find("test.pbrt:4:1: a medium named \"Tea\""), std::string::npos);
  EXPECT_NE(with("\"string name\" \"Skin1\" \"rgb reflectance\" [ 1 1 1 ]").find("stated more than once"),
            std::string::npos);
  EXPECT_NE(with("\"string name\" \"Skin1\" \"float g\" .5").find("test.pbrt:4:23: named media"),
            std::string::npos);
  EXPECT_EQ(with("\"rgb reflectance\" [ 1 1 1 ] \"float mfp\" 0"),
            "test.pbrt:4:29: a mean free path of 0 at 450 nm; 1e-12 or more would be right");
  EXPECT_NE(with("\"rgb reflectance\" [ 1 1 1 ] \"float eta\" .9").find("test.pbrt:4:29: an index of 0.9 at"),
            std::string::npos);
  EXPECT_NE(with("\"texture reflectance\" \"t\"").find("there is no spectrum texture"), std::string::npos);
  EXPECT_NE(with("\"float scale\" -1").find("test.pbrt:4:1"), std::string::npos);
  EXPECT_NE(media_message("MakeNamedMaterial \"a\" \"string type\" \"subsurface\"\nMaterial \"mix\" \"string "
                          "materials\" [ \"a\" \"a\" ]")
                .find("test.pbrt:4:16: a mix with a subsurface material"),
            std::string::npos);
}

}  // namespace
}  // namespace petzval::render
