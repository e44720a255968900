// SPDX-License-Identifier: BSD-3-Clause
// Sheen: its albedo by a quadrature of its own, reciprocity, furnaces, and the glTF extension.
#include <gtest/gtest.h>
#include <petzval/base/units.h>
#include <petzval/numeric/quadrature.h>
#include <petzval/render/materials/sheen.h>

#include "media_scenes.h"

namespace petzval::render {
namespace {

Vector3 direction_at(double cos, double turn) {
  const double sin = std::sqrt(1 - cos * cos);
  return {sin * std::cos(turn), sin * std::sin(turn), cos};
}

double integrated(const std::function<double(Vector3)>& f) {
  const QuadratureRule roots = gauss_legendre(100, 0, 1), turns = gauss_legendre(100, 0, pi);
  double sum = 0;
  for (std::size_t i = 0; i < roots.nodes.size(); ++i)
    for (std::size_t j = 0; j < turns.nodes.size(); ++j) {
      const double cos = roots.nodes[i] * roots.nodes[i];
      sum += 4 * roots.nodes[i] * roots.weights[i] * turns.weights[j] * cos *
             f(direction_at(cos, turns.nodes[j]));
    }
  return sum;
}

TEST(Sheen, TakesTheLightThatItSays) {
  const Sheen sheen;
  for (const double alpha : {0.01, 0.03, 0.1, 0.37, 1.0})
    for (const double cos : {0.02, 0.11, 0.3, 0.62, 1.0}) {
      const double taken =
          integrated([&](Vector3 wi) { return sheen.value(direction_at(cos, 0), wi, alpha); });
      EXPECT_LE(taken, sheen.albedo(cos, alpha) + 0.01) << alpha << " " << cos;
      // Wide fibres are dimmed nowhere.
      if (alpha > 0.09) {
        EXPECT_NEAR(taken, sheen.albedo(cos, alpha), 0.01) << alpha << " " << cos;
      }
    }
  // Straight on, by hand-made sums of the published formulas (400 x 400 midpoints).
  EXPECT_NEAR(sheen.albedo(1, 1), 0.1638, 0.002);
  EXPECT_NEAR(sheen.albedo(0.3, 0.3), 0.3443, 0.004);
}

/// The surface of a sphere made of one material.
Bsdf surface(const World& world) {
  return world.materials.back().bsdf({}, 0, 0);
}

const char* const cloths[] = {
    "Material \"diffuse\" \"rgb reflectance\" [ 1 1 1 ] \"rgb sheencolor\" [ 1 1 1 ] \"float "
    "sheenroughness\" .7",
    "Material \"diffuse\" \"rgb reflectance\" [ 1 1 1 ] \"rgb sheencolor\" [ .9 .3 .1 ] \"float "
    "sheenroughness\" .1",
    "Material \"coateddiffuse\" \"rgb reflectance\" [ 1 1 1 ] \"float roughness\" .3 \"rgb sheencolor\" [ 1 "
    "1 1 ] "
    "\"float sheenroughness\" .4",
    "Material \"conductor\" \"rgb reflectance\" [ 1 1 1 ] \"float roughness\" .3 \"rgb sheencolor\" [ .5 .5 "
    ".5 ] "
    "\"float sheenroughness\" 1"};

TEST(Sheen, IsReciprocal) {
  for (const std::string cloth : cloths) {
    const auto world = world_of(cloth + "\nShape \"sphere\"\n");
    const Bsdf bsdf = surface(*world);
    for (const double cos : {0.03, 0.4, 0.9})
      for (const double turn : {0.0, 1.0, 3.0}) {
        const Vector3 wo = direction_at(0.6, 0.5), wi = direction_at(cos, turn);
        for (int lane = 0; lane < 3; ++lane) {
          const auto there = static_cast<double>(bsdf.value(wo, wi)[lane]),
                     back = static_cast<double>(bsdf.value(wi, wo)[lane]);
          EXPECT_NEAR(there, back, 1e-5 * there) << cloth;
          EXPECT_GT(there, 0);
        }
      }
  }
}

/// In even light of 1 no cloth shines by more, and asking lights and meeting them by chance agree.
TEST(Sheen, GivesNoMoreThanTheLightOfAFurnace) {
  for (const std::string cloth : cloths) {
    const auto world = world_of(white_furnace + cloth + "\nShape \"sphere\" \"float radius\" 1\n");
    for (const double height : {0.1, 0.7, 0.99}) {
      const Vector3 from{0, height, -3}, along{0, 0, 1};
      const Estimate found = seen(*world, from, along, 1 << 13),
                     chance = seen(*world, from, along, 1 << 15, PathOptions::Lights::by_chance);
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_LE(found.mean[i], 1.005 + 4 * found.deviation[i]) << cloth << height;
        EXPECT_GT(found.mean[i], 0.5) << cloth << height;
        EXPECT_NEAR(found.mean[i], chance.mean[i],
                    0.005 + 4.5 * std::hypot(found.deviation[i], chance.deviation[i]))
            << cloth << height;
      }
    }
  }
}

TEST(Sheen, RefusesWhatItCannotCover) {
  EXPECT_NE(media_message("Material \"dielectric\"\n\"rgb sheencolor\" [ 1 1 1 ]\nShape \"sphere\"")
                .find("test.pbrt:4:1: sheen on a material of this kind"),
            std::string::npos);
}

}  // namespace
}  // namespace petzval::render
