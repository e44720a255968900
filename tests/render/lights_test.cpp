// SPDX-License-Identifier: BSD-3-Clause
// Lights by two laws: what asks them draws directions as its density says, and whoever finds them, the light
// that arrives is the same.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "scene_text.h"
#include "sphere_cells.h"

namespace petzval::render {
namespace {

struct NamedText {
  const char* name;
  std::string text;
};
void PrintTo(const NamedText& each, std::ostream* out) {
  *out << each.name;
}

const std::string lamp =
    "AreaLightSource \"diffuse\" \"spectrum L\" [ 300 2 900 2 ] \"bool twosided\" true\n";

/// Around or above the point (0, 0, 0).
std::vector<NamedText> lights() {
  const auto block = [](const std::string& text) { return "AttributeBegin\n" + text + "\nAttributeEnd\n"; };
  return {
      {"disk", block(lamp + "Translate 0.4 0.2 1\nRotate 30 1 0 0\nShape \"disk\" \"float radius\" 0.8 "
                            "\"float innerradius\" 0.2")},
      {"sphere", block(lamp + "Translate 0.2 0.3 1.5\nShape \"sphere\" \"float radius\" 0.7")},
      {"sphere around", block(lamp + "Translate 0.2 0.3 0.5\nShape \"sphere\" \"float radius\" 3")},
      {"ellipsoid", block(lamp + "Translate 0.2 0.3 1.5\nScale 1.2 0.5 0.8\nShape \"sphere\"")},
      {"part of a sphere",
       block(lamp + "Translate 0 0 1.5\nShape \"sphere\" \"float zmin\" -0.2 \"float zmax\" "
                    "0.7 \"float phimax\" 200")},
      {"cylinder", block(lamp + "Translate 0 0 1.6\nRotate 80 0 1 0\nShape \"cylinder\" \"float radius\" 0.5 "
                                "\"float zmin\" -1 \"float zmax\" 1")},
      {"triangles", block(lamp + "Shape \"trianglemesh\" \"point3 P\" [ -1 -1 1  1 -1 1.5  1 1 1  -1 1 0.8 ] "
                                 "\"integer indices\" [ 0 1 2 0 2 3 ]")},
      {"two lamps", block(lamp + "Translate -1 0 1\nShape \"sphere\" \"float radius\" 0.5") +
                        block(lamp + "Translate 1 0.5 1\nShape \"disk\" \"float radius\" 0.5")},
      {"sky", "LightSource \"infinite\" \"spectrum L\" [ 300 1 900 1 ]\n"}};
}

class EachLight : public testing::TestWithParam<NamedText> {};

/// The density with which the world's lights are found in a direction from a point. Points of curved lights
/// are drawn over their area, so that it grows as 1/cos towards their outline, where no rule would integrate
/// it: grazing light is left out.
double light_pdf(const World& world, const LightPlan& plan, Vector3 direction) {
  const Vector3 from = plan.to.position;
  constexpr double grazing = 0.1;
  const auto hit = world.intersector->nearest(from, direction, std::numeric_limits<double>::infinity());
  if (!hit) return world.lights.sky_pdf(plan, direction);
  const Geometry& geometry = world.geometries[static_cast<std::size_t>(hit->geometry)];
  const SurfacePoint point = surface_point(geometry, *hit, from, direction, world.place_of(*hit));
  if (std::abs(dot(point.normal, direction)) < grazing) return 0;
  return world.lights.area_pdf(world.geometries,
                               static_cast<std::size_t>(geometry.first_light + hit->primitive), plan, point);
}

TEST_P(EachLight, IsDrawnFromItsDensity) {
  const auto world = world_of(GetParam().text);
  constexpr int samples = 100000;
  const Vector3 from{0, 0, 0};
  const LightPlan plan = world->lights.plan({from, {0, 0, 1}, true});
  SphereCells cells;
  for (int i = 0; i < samples; ++i) {
    SobolSample sample(hashed(7, static_cast<std::uint32_t>(i)), 0);  // independent, for χ²
    const auto [choice, u, v, none] = sample.next4();
    (void)none;
    const auto light = world->lights.sample(world->geometries, plan, choice, u, v, 0);
    if (!light) continue;
    // What lies behind another part of the light is found by the shadow ray, not here.
    if (light->place && world->intersector->blocked(from, *light->place - from, 1 - 1e-6)) continue;
    if (light_pdf(*world, plan, light->direction) > 0) cells.count(light->direction);
  }
  // Outlines of lights across cells of 100² points: two in a thousand.
  cells.expect_density(samples, 100, 0.002, GetParam().name,
                       [&](Vector3 direction) { return light_pdf(*world, plan, direction); });
}

struct Mean {
  double value = 0, error = 0;
};

/// Light that comes back from a floor at z = 0, seen from the side, after one reflection.
Mean from_floor(const World& world, PathOptions::Lights lights) {
  PathOptions path;
  path.max_depth = 1;
  path.lights = lights;
  const PathTracer tracer(world, path);
  const Vector3 eye{-0.9, -0.4, 0.5};
  const Vector3 direction = normalised(Vector3{} - eye);
  constexpr int samples = 20000;
  double sum = 0, squares = 0;
  for (int i = 0; i < samples; ++i) {
    SobolSample sample(hashed(41, static_cast<std::uint32_t>(i)), 0);
    const PathLight light = tracer.trace(eye, direction, 0, 0, sample);
    const double value = static_cast<double>(light.shared[0] + light.alone);
    sum += value, squares += value * value;
  }
  const double mean = sum / samples;
  return {mean, std::sqrt((squares / samples - mean * mean) / samples)};
}

TEST_P(EachLight, GivesTheSameLightWhoeverFindsIt) {
  for (const char* material :
       {"Material \"diffuse\"", "Material \"coateddiffuse\" \"float roughness\" 0.3",
        "Material \"conductor\" \"float roughness\" 0.3", "Material \"dielectric\" \"float roughness\" 0.4",
        "Material \"diffusetransmission\""}) {
    const auto world =
        world_of(GetParam().text + material + "\nShape \"disk\" \"float radius\" 0.01 \"float height\" 0\n");
    const Mean both = from_floor(*world, PathOptions::Lights::both),
               sampled = from_floor(*world, PathOptions::Lights::sampled),
               by_chance = from_floor(*world, PathOptions::Lights::by_chance);
    ASSERT_GT(both.value, 0) << material;
    EXPECT_LT(both.error, 0.02 * both.value) << material;
    // Four standard errors: one comparison in 16,000 would fail by chance, and the numbers are always the
    // same.
    EXPECT_NEAR(both.value, sampled.value, 4 * std::hypot(both.error, sampled.error)) << material;
    EXPECT_NEAR(both.value, by_chance.value, 4 * std::hypot(both.error, by_chance.error)) << material;
    // What MIS promises: never worse than the worse way.
    EXPECT_LE(both.error, 1.05 * std::max(sampled.error, by_chance.error)) << material;
  }
}

INSTANTIATE_TEST_SUITE_P(Lights, EachLight, testing::ValuesIn(lights()));

/// White surfaces of every shape in light of radiance 1 from everywhere: seen from anywhere they are as
/// bright as the light, or rays slip through, or meet their own surface again.
class FurnaceOfShapes : public testing::TestWithParam<NamedText> {};

TEST_P(FurnaceOfShapes, CannotBeSeen) {
  const auto world = world_of(std::string(white_furnace) +
                              "Material \"diffuse\" \"rgb reflectance\" [ 1 1 1 ]\n" + GetParam().text);
  PathOptions options;
  options.max_depth = 100;  // inside of hollow shapes light goes round for long
  const PathTracer tracer(*world, options);
  int met = 0;
  for (int ray = 0; ray < 12; ++ray) {
    SobolSample place(5, static_cast<std::uint32_t>(ray));
    const auto [a, b, c, d] = place.next4();
    const Vector3 eye{6 * a - 3, 6 * b - 3, -4}, target{0.6 * c - 0.3, 0.6 * d - 0.3, 0};
    double sum = 0;
    constexpr int samples = 2048;
    FirstSurface first;
    for (int i = 0; i < samples; ++i) {
      SobolSample sample(hashed(17, static_cast<std::uint32_t>(ray)), static_cast<std::uint32_t>(i));
      sum += static_cast<double>(tracer
                                     .trace(eye, normalised(target - eye), 0, 0, sample,
                                            std::numeric_limits<double>::infinity(), &first)
                                     .shared[0]) /
             samples;
    }
    met += first.met;
    // Sobol points; roulette and the hundredth reflection leave some parts in a thousand.
    EXPECT_NEAR(sum, 1, 5e-3) << "ray " << ray;
  }
  EXPECT_GT(met, 3);
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, FurnaceOfShapes,
    testing::Values(
        NamedText{"sphere", "Shape \"sphere\""},
        NamedText{"large sphere", "Scale 1e3 1e3 1e3\nTranslate 0 0 1.001\nShape \"sphere\""},
        NamedText{"part of a sphere", "Shape \"sphere\" \"float zmax\" 0.4 \"float phimax\" 220"},
        NamedText{"mirrored ellipsoid", "Scale -1 0.5 0.8\nShape \"sphere\""},
        NamedText{"disk", "Rotate 20 1 0 0\nShape \"disk\" \"float innerradius\" 0.1"},
        NamedText{"cylinder", "Rotate 70 1 0 0\nShape \"cylinder\""},
        NamedText{"triangles",
                  "ReverseOrientation\nShape \"trianglemesh\" \"point3 P\" [ -2 -2 0 2 -2 0.3 2 2 0 -2 2 0.5 "
                  "] \"integer "
                  "indices\" [ 0 1 2 0 2 3 ]"},
        NamedText{"bilinear patch", "Shape \"bilinearmesh\" \"point3 P\" [ -2 -2 0 2 -2 1 -2 2 1 2 2 0 ]"},
        NamedText{"tube",
                  "Shape \"curve\" \"string type\" \"cylinder\" \"float width\" 0.6 \"float width1\" 0.2 "
                  "\"point3 P\" "
                  "[ -1 -1 0 -1 1 0 1 -1 0.5 1 1 0 ]"},
        NamedText{"ribbon",
                  "Shape \"curve\" \"float width\" 0.6 \"point3 P\" [ -1 -1 0 -1 1 0 1 -1 0.5 1 1 0 ]"},
        NamedText{
            "placed tube",
            "ObjectBegin \"o\"\nShape \"curve\" \"string type\" \"cylinder\" \"float width\" 0.6 \"point3 "
            "P\" [ -1 -1 0 -1 1 0 1 -1 0.5 1 1 0 ]\nObjectEnd\nRotate 30 0 0 1\nObjectInstance \"o\""},
        NamedText{
            "placed objects",
            "ObjectBegin \"o\"\nShape \"sphere\" \"float radius\" 0.5\nShape \"disk\"\nObjectEnd\nScale 1 2 "
            "1\nObjectInstance \"o\"\nTranslate 0.4 0.3 0.5\nObjectInstance \"o\"\n"}));

}  // namespace
}  // namespace petzval::render
