// SPDX-License-Identifier: BSD-3-Clause
// Curves against shapes and splines that are known otherwise.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

#include "scene_text.h"

namespace petzval::render {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

CurveSegments curve_of(const std::string& text) {
  Unsupported unsupported;
  return read_curve(described("Shape \"curve\" " + text).shapes.at(0), unsupported);
}

std::string curve_refusal(const std::string& text) {
  try {
    world_of(text);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

std::optional<SurfacePoint> met(const World& world, Vector3 origin, Vector3 direction) {
  const auto hit = world.intersector->nearest(origin, direction, infinity);
  if (!hit) return {};
  return surface_point(world.geometries[static_cast<std::size_t>(hit->geometry)], *hit, origin, direction,
                       world.place_of(*hit));
}

/// Rays from around towards a straight piece along z, from −1 to 1.
struct Shot {
  Vector3 origin, direction;
};
std::vector<Shot> shots(int count) {
  std::vector<Shot> result;
  for (int i = 0; i < count; ++i) {
    SobolSample sample(21, static_cast<std::uint32_t>(i));
    const auto [a, b, c, d] = sample.next4();
    const double angle = 6.28 * a;
    const Vector3 origin{3 * std::cos(angle), 3 * std::sin(angle), 2 * b - 1};
    const Vector3 target{0.3 * (2 * c - 1) * std::sin(angle), -0.3 * (2 * c - 1) * std::cos(angle),
                         1.2 * d - 0.6};
    result.push_back({origin, normalised(target - origin)});
  }
  return result;
}

TEST(Curves, StraightTubeIsACylinder) {
  const auto tube = world_of(
      "Shape \"curve\" \"string type\" \"cylinder\" \"float width\" 0.4 \"point3 P\" [ 0 0 -1  0 0 -.4  0 0 "
      ".3  0 0 "
      "1 ]");
  const auto cylinder =
      world_of("Shape \"cylinder\" \"float radius\" 0.2 \"float zmin\" -1 \"float zmax\" 1");
  int both = 0, different = 0;
  for (const Shot& shot : shots(2000)) {
    const auto a = met(*tube, shot.origin, shot.direction), b = met(*cylinder, shot.origin, shot.direction);
    if (a.has_value() != b.has_value()) ++different;
    if (!a || !b) continue;
    ++both;
    // Single precision, and an iteration that ends near the surface: a thousandth of the radius.
    EXPECT_LT(length(a->position - b->position), 2e-4);
    EXPECT_GT(dot(a->normal, b->normal), 0.9999);
  }
  EXPECT_GT(both, 500);
  EXPECT_LT(different, 10);  // at the outline
}

TEST(Curves, RibbonFacesWhoeverLooks) {
  const auto ribbon =
      world_of("Shape \"curve\" \"float width\" 0.4 \"point3 P\" [ 0 0 -1  0 0 -.4  0 0 .3  0 0 1 ]");
  int hits = 0, different = 0;
  for (const Shot& shot : shots(2000)) {
    // How far the ray passes the axis.
    const Vector3 across = cross(shot.direction, Vector3{0, 0, 1});
    const double apart = std::abs(dot(shot.origin, across)) / length(across);
    const auto point = met(*ribbon, shot.origin, shot.direction);
    if (point.has_value() != (apart < 0.2)) ++different;
    if (!point) continue;
    ++hits;
    EXPECT_LT(dot(point->normal, shot.direction), 0);
    EXPECT_NEAR(point->normal.z, 0, 1e-5);
    EXPECT_NEAR(std::abs(point->v - 0.5) * 0.4, apart, 1e-3);
  }
  EXPECT_GT(hits, 500);
  EXPECT_LT(different, 10);
}

/// Uniform B-splines by de Boor's basis functions, at places of each piece.
TEST(Curves, SplinesPassWhereTheirBasisFunctionsSay) {
  const std::string points = "\"point3 P\" [ 0 0 0  1 2 0  3 1 1  4 -1 2  6 0 0 ]";
  const std::vector<Vector3> p{{0, 0, 0}, {1, 2, 0}, {3, 1, 1}, {4, -1, 2}, {6, 0, 0}};
  for (const double t : {0.0, 0.3, 0.8, 1.0}) {
    const CurveSegments cubic = curve_of("\"string basis\" \"bspline\" " + points);
    ASSERT_EQ(cubic.segments(), 2u);
    const double s = 1 - t;
    const double three[4] = {s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6,
                             (-3 * t * t * t + 3 * t * t + 3 * t + 1) / 6, t * t * t / 6};
    const CurveSegments square = curve_of("\"integer degree\" 2 \"string basis\" \"bspline\" " + points);
    ASSERT_EQ(square.segments(), 3u);
    const double two[3] = {s * s / 2, (1 + 2 * t - 2 * t * t) / 2, t * t / 2};
    for (std::size_t i = 0; i < 3; ++i) {
      Vector3 expected_2, expected_3;
      for (std::size_t k = 0; k < 3; ++k) expected_2 = expected_2 + two[k] * p[i + k];
      EXPECT_LT(length(square.at(i, t).centre - expected_2), 1e-6);
      for (std::size_t k = 0; k < 4 && i < 2; ++k) expected_3 = expected_3 + three[k] * p[i + k];
      if (i < 2) {
        EXPECT_LT(length(cubic.at(i, t).centre - expected_3), 1e-6);
      }
    }
  }
  const CurveSegments bezier = curve_of("\"integer degree\" 2 " + points);
  ASSERT_EQ(bezier.segments(), 2u);
  EXPECT_LT(length(bezier.at(1, 0.5).centre - (0.25 * p[2] + 0.5 * p[3] + 0.25 * p[4])), 1e-6);
}

TEST(Curves, WidthRunsFromEndToEndAndGrowsWithTheScene) {
  const CurveSegments curve = curve_of(
      "\"float width0\" 1 \"float width1\" 0.5 \"integer degree\" 2 \"point3 P\" [ 0 0 0 1 0 0 2 0 0 3 0 0 4 "
      "0 0 ]");
  EXPECT_NEAR(curve.at(0, 0).radius, 0.5, 1e-6);
  EXPECT_NEAR(curve.at(0, 0.5).radius, 0.4375, 1e-6);
  EXPECT_NEAR(curve.at(1, 0).radius, 0.375, 1e-6);
  EXPECT_NEAR(curve.at(1, 1).radius, 0.25, 1e-6);
  Unsupported unsupported;
  const CurveSegments large = read_curve(
      described("Scale 3 3 3\nRotate 40 1 2 3\nShape \"curve\" \"point3 P\" [ 0 0 0 1 0 0 2 0 0 3 0 0 ]")
          .shapes.at(0),
      unsupported);
  EXPECT_NEAR(large.at(0, 0.2).radius, 1.5, 1e-5);
}

TEST(Curves, RefuseWhatMakesNoSense) {
  const auto expect = [](const std::string& text, const std::string& place, const std::string& part) {
    const std::string message = curve_refusal(text);
    EXPECT_EQ(message.rfind(place, 0), 0u) << message;
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  const std::string p = " \"point3 P\" [ 0 0 0 1 0 0 2 0 0 3 0 0 ]";
  expect("Shape \"curve\"", "test.pbrt:3:1: ", "point3 P");
  expect("Shape \"curve\" \"point3 P\" [ 0 0 0 1 0 0 2 0 0 ]", "test.pbrt:3:15: ", "through 3 points");
  expect("Shape \"curve\" \"integer degree\" 4" + p, "test.pbrt:3:15: ", "2 or 3");
  expect("Shape \"curve\" \"float width\" -1" + p, "test.pbrt:3:15: ", "0 or more");
  expect("Shape \"curve\" \"string type\" \"plate\"" + p, "test.pbrt:3:15: ", "plate");
  expect("Scale 1 2 1\nShape \"curve\"" + p, "test.pbrt:4:1: ", "stretched");
  expect("AreaLightSource \"diffuse\"\nShape \"curve\"" + p, "test.pbrt:4:1: ", "shines");
}

double area_of(const World& world) {
  double area = 0;
  for (std::size_t i = 0; i < world.geometries.at(0).primitives(); ++i)
    area += world.geometries[0].primitive_area(i);
  return area;
}

constexpr const char* along_z = "\"point3 P\" [ 0 0 0  0 0 1  0 0 2  0 0 3 ] ";

TEST(Ribbons, FaceAlongTheirNormals) {
  const auto world = world_of(std::string("Shape \"curve\" \"string type\" \"ribbon\" \"float width\" 0.4 ") +
                              along_z + "\"normal N\" [ 0 1 0  0 1 0 ]");
  EXPECT_NEAR(area_of(*world), 3 * 0.4, 1e-5);
  const auto on = met(*world, {0.19, 5, 1.5}, {0, -1, 0});
  ASSERT_TRUE(on);
  EXPECT_NEAR(on->normal.y, 1, 1e-6);
  EXPECT_NEAR(on->u, 0.5, 1e-5);
  EXPECT_NEAR(on->v, 0.5 + 0.19 / 0.4, 1e-5);  // across is normal × tangent, +x
  EXPECT_FALSE(met(*world, {0.21, 5, 1.5}, {0, -1, 0}));
  EXPECT_FALSE(met(*world, {5, 0.001, 1.5}, {-1, 0, 0}));  // seen on edge
}

/// ∬ √(1 + (Θv/L)²) dv dz over the length L and width w of a helicoid that turns by Θ.
TEST(Ribbons, TwistLikeAHelicoid) {
  const auto world = world_of(std::string("Shape \"curve\" \"string type\" \"ribbon\" \"float width\" 2 ") +
                              along_z + "\"normal N\" [ 0 1 0  1 0 0 ]");
  const double slope = 1.5707963267948966 / 3;  // to v = 1
  const double area = 3 * (std::sqrt(1 + slope * slope) + std::asinh(slope) / slope);
  // The trapezoid rule over eight strips: slope² (2/8)²/12 of the part that is not flat.
  EXPECT_NEAR(area_of(*world) / area, 1, 1.5e-3);
  // A third of the way along it has turned by 30 degrees, from the y axis towards the x axis.
  const auto on = met(*world, {5 * std::sin(0.5235988), 5 * std::cos(0.5235988), 1},
                      {-std::sin(0.5235988), -std::cos(0.5235988), 0});
  ASSERT_TRUE(on);
  EXPECT_NEAR(on->shading_normal.x, 0.5, 2e-3);
  EXPECT_NEAR(on->shading_normal.y, std::sqrt(0.75), 2e-3);
}

TEST(Ribbons, NeedANormalAtEveryEnd) {
  const std::string start = std::string("Shape \"curve\" \"string type\" \"ribbon\" ") + along_z;
  EXPECT_NE(curve_refusal(start).find("three for each of its 2"), std::string::npos) << curve_refusal(start);
  EXPECT_NE(curve_refusal(start + "\"normal N\" [ 0 1 0 ]").find("3 numbers"), std::string::npos);
  EXPECT_NE(curve_refusal(start + "\"normal N\" [ 0 1 0  0 0 0 ]").find("no length"), std::string::npos);
  EXPECT_NE(curve_refusal(start + "\"normal N\" [ 0 1 0  0 -1 0 ]").find("either way"), std::string::npos);
}

}  // namespace
}  // namespace petzval::render
