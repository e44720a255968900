// SPDX-License-Identifier: BSD-3-Clause
// Heights that tilt the shading normal: Lambert's law and closed forms for the normal that is meant.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/image/formats/png.h>
#include <petzval/render/textures/bump_map.h>

#include <cmath>

#include "scene_text.h"
#include "scratch.h"

namespace petzval::render {
namespace {

/// a u + b v.
class EvenSlope final : public Texture<double> {
 public:
  EvenSlope(double a, double b) : a_(a), b_(b) {}
  double at(const TexturePoint& point, int) const override { return a_ * point.u + b_ * point.v; }

 private:
  double a_, b_;
};

/// The normals of the surface and of the bumps where a ray to `towards` meets the first shape.
struct BumpedPoint {
  SurfacePoint point;
  Vector3 along_v, normal;
};
BumpedPoint bumped_point(const std::string& shape, double a, double b, Vector3 from, Vector3 towards) {
  // A material with bumps, so that coordinates are asked for.
  const auto world = world_of(
      "Texture \"t\" \"float\" \"checkerboard\"\nMaterial \"diffuse\" \"texture displacement\" \"t\"\n" +
      shape);
  const Vector3 way = normalised(towards - from);
  const auto hit = world->intersector->nearest(from, way, 100);
  if (!hit) throw Failure("nothing is met");
  const Geometry& geometry = world->geometries[static_cast<std::size_t>(hit->geometry)];
  const Transform* place = world->place_of(*hit);
  BumpedPoint result;
  result.point = surface_point(geometry, *hit, from, way, place);
  result.along_v = along_v(geometry, *hit, result.point, place);
  result.normal = BumpMap(std::make_shared<EvenSlope>(a, b)).normal_at(result.point, result.along_v);
  return result;
}

const char* const bumped_shapes[] = {
    "Shape \"sphere\" \"float radius\" 1.5 \"float zmin\" -1 \"float zmax\" 1.2",
    "Shape \"cylinder\" \"float radius\" 1 \"float zmin\" -1.5 \"float zmax\" 1",
    "Rotate 60 1 0.2 0\nShape \"disk\" \"float radius\" 2 \"float innerradius\" 0.2",
    "Scale -1 1 2\nShape \"sphere\"",
    "ReverseOrientation\nShape \"sphere\"",
    "Shape \"trianglemesh\" \"point3 P\" [ -2 0 -2 2 0.5 -2 2 0 2 ] \"point2 uv\" [ 0 0 3 0 0 2 ]",
    "ObjectBegin \"o\"\nShape \"sphere\"\nObjectEnd\nRotate 30 1 2 3\nScale 1 2 1.5\nObjectInstance \"o\"",
};

/// ∂p/∂v: of two points near to each other, what their coordinates and ∂p/∂u leave.
TEST(BumpMap, KnowsHowAPlaceMovesWithV) {
  for (const char* shape : bumped_shapes)
    for (const Vector3 aside : {Vector3{1e-4, 0, 0}, {0, 0, 1e-4}}) {
      const Vector3 from{0.3, -5, 0.2}, to{0.25, 0, 0.15};
      const BumpedPoint one = bumped_point(shape, 0, 0, from, to),
                        two = bumped_point(shape, 0, 0, from + aside, to + aside);
      const double du = two.point.u - one.point.u, dv = two.point.v - one.point.v;
      const Vector3 moved = two.point.position - one.point.position;
      // To the bend of the surface over 1e-4, and what floats leave of it.
      EXPECT_LT(length(moved - du * one.point.along_u - dv * one.along_v), 2e-3 * length(moved)) << shape;
    }
}

/// p + h n, differentiated: the normal is across both of its slopes, and on the old one's side.
TEST(BumpMap, IsTheNormalOfTheRaisedSurface) {
  for (const char* shape : bumped_shapes)
    for (const auto& [a, b] : {std::pair{0.0, 0.0}, {0.5, 0.0}, {0.0, -0.4}, {0.3, 0.8}}) {
      const BumpedPoint at = bumped_point(shape, a, b, {0.3, -5, 0.2}, {0.25, 0, 0.15});
      const Vector3 n = at.point.shading_normal;
      EXPECT_NEAR(length(at.normal), 1, 1e-12);
      EXPECT_GT(dot(at.normal, n), 0) << shape;
      EXPECT_NEAR(dot(at.normal, at.point.along_u + a * n), 0, 1e-6) << shape;
      EXPECT_NEAR(dot(at.normal, at.along_v + b * n), 0, 1e-6) << shape;
    }
}

/// A wall in z = 0 of 2 × 2, lit by a distant light of irradiance π.
double wall_radiance(const std::string& texture, const std::string& parameters, Vector3 to_light, double x) {
  const auto world = world_of(
      "LightSource \"distant\" \"spectrum L\" [ 300 3.14159265 900 3.14159265 ] \"point3 from\" [ " +
      std::to_string(to_light.x) + " " + std::to_string(to_light.y) + " " + std::to_string(to_light.z) +
      " ] \"point3 to\" [ 0 0 0 ]\n" + texture + "\nMaterial \"diffuse\" \"rgb reflectance\" [ 1 1 1 ] " +
      parameters + "\nShape \"bilinearmesh\" \"point3 P\" [ -1 -1 0 1 -1 0 -1 1 0 1 1 0 ]\n");
  SobolSample sample(1, 0);
  const PathTracer tracer(*world, {.max_depth = 1});
  return static_cast<double>(tracer.trace({x, 0.1, 3}, {0, 0, -1}, 0, 0, sample).shared[0]);
}

/// A picture of two pixels, whose height rises from one to the other: where it is between them.
TEST(BumpMap, LightsAWallAsIfItLeant) {
  const test::Scratch scratch;
  PngImage picture;
  picture.columns = 2, picture.rows = 1, picture.channels = 1, picture.bits = 16,
  picture.samples = {0, 32768};
  write_png(scratch.path("rise.png"), picture);
  for (const double scale : {0.0, 1.0, -2.0}) {
    const std::string texture =
        "Texture \"t\" \"float\" \"imagemap\" \"string encoding\" \"linear\" \"string filename\" \"" +
        scratch.path("rise.png") + "\" \"float scale\" " + std::to_string(scale);
    // Half of the scale over half of the wall's width of 2.
    const Vector3 n = normalised(Vector3{-0.5 * scale, 0, 1});
    for (const Vector3 light : {Vector3{0, 0, 1}, {0.7, 0.2, 0.7}, {-0.3, 0.8, 0.5}})
      EXPECT_NEAR(wall_radiance(texture, "\"texture displacement\" \"t\"", light, 0),
                  std::max(0.0, dot(n, normalised(light))), 2e-4);  // 16 bits, and floats of light
  }
}

TEST(BumpMap, IsNoneWhereTheHeightIsTheSame) {
  const Vector3 light{0.7, 0.2, 0.7};
  const double flat = wall_radiance("", "", light, 0);
  EXPECT_EQ(wall_radiance("", "\"float displacement\" 0.3", light, 0), flat);
  EXPECT_THROW(wall_radiance("", "\"texture displacement\" \"none\"", light, 0), InputError);
}

}  // namespace
}  // namespace petzval::render
