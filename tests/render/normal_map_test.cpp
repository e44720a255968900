// SPDX-License-Identifier: BSD-3-Clause
// Surfaces that lean as a picture says: Lambert's law for the normal that is meant.
#include <gtest/gtest.h>
#include <petzval/base/units.h>
#include <petzval/image/formats/png.h>
#include <petzval/render/textures/normal_map.h>

#include <cmath>

#include "scene_text.h"
#include "scratch.h"

namespace petzval::render {
namespace {

/// A normal as a picture has it, to 16 bits.
std::vector<std::uint16_t> encoded(Vector3 n) {
  const auto level = [](double x) { return static_cast<std::uint16_t>(std::lround((x + 1) / 2 * 65535)); };
  return {level(n.x), level(n.y), level(n.z)};
}

PngImage picture_of(Vector3 n) {
  PngImage png;
  png.columns = png.rows = 1, png.bits = 16, png.samples = encoded(n);
  return png;
}

/// A wall in z = 0, u along x and v along y, that a distant light of irradiance π shines on; seen from +z.
double radiance(const std::string& normal_map, Vector3 to_light, bool mesh) {
  const auto numbers = [](Vector3 v) {
    return std::to_string(v.x) + " " + std::to_string(v.y) + " " + std::to_string(v.z);
  };
  const auto world =
      world_of("LightSource \"distant\" \"spectrum L\" [ 300 3.14159265 900 3.14159265 ] \"point3 from\" [ " +
               numbers(to_light) +
               " ] \"point3 to\" [ 0 0 0 ]\nMaterial \"diffuse\" \"rgb reflectance\" [ 1 1 1 ] \"string "
               "normalmap\" \"" +
               normal_map + "\"\n" +
               (mesh ? "Shape \"trianglemesh\" \"point3 P\" [ -1 -1 0 1 -1 0 1 1 0 -1 1 0 ] \"point2 uv\" [ "
                       "0 0 1 0 1 1 0 1 ] "
                       "\"integer indices\" [ 0 1 2 0 2 3 ]\n"
                     : "Shape \"bilinearmesh\" \"point3 P\" [ -1 -1 0 1 -1 0 -1 1 0 1 1 0 ]\n"));
  SobolSample sample(1, 0);
  PathOptions options;
  options.max_depth = 1;
  return static_cast<double>(
      PathTracer(*world, options).trace({0.2, 0.1, 3}, {0, 0, -1}, 0, 0, sample).shared[0]);
}

TEST(NormalMap, LightsAWallByTheCosineOfItsNormal) {
  const test::Scratch scratch;
  for (const Vector3 lean : {Vector3{0, 0, 1}, {0.5, 0, 0.866}, {0, -0.6, 0.8}, {0.3, 0.4, 0.866}}) {
    const Vector3 n = normalised(lean);
    write_png(scratch.path("n.png"), picture_of(n));
    for (const Vector3 light : {Vector3{0, 0, 1}, {0.7, 0.2, 0.7}, {-0.3, 0.8, 0.5}})
      for (const bool mesh : {true, false})
        EXPECT_NEAR(radiance(scratch.path("n.png"), light, mesh), std::max(0.0, dot(n, normalised(light))),
                    2e-4);  // 16 bits, and floats of light
  }
}

TEST(NormalMap, LeansTowardsVWhereAPictureIsMirrored) {
  auto picture = std::make_shared<PictureFile>(PictureFile{1, 1, 3, {0.5f, 0.9f, 0.8f}});
  const NormalMap gltf(PictureSampler(picture, PictureWrap::repeat, true), TextureMapping(), 1, true);
  const NormalMap pbrt(PictureSampler(picture, PictureWrap::repeat, true), TextureMapping(), 1, false);
  for (const char* uv : {"0 0 1 0 1 1 0 1", "0 1 1 1 1 0 0 0", "1 0 0 0 0 1 1 1", "0 0 0 1 1 1 1 0"})
    for (const char* way : {"", "ReverseOrientation\n", "Scale -1 1 1\n"}) {
      const auto world =
          world_of(std::string(way) +
                   "Shape \"trianglemesh\" \"point3 P\" [ -1 -1 0 1 -1 0 1 1 0 -1 1 0 ] \"point2 uv\" [ " +
                   uv + " ] \"integer indices\" [ 0 1 2 0 2 3 ]\n");
      const Vector3 from{0.2, 0.1, 3}, down{0, 0, -1}, step{0, 0.01, 0};
      const auto point_at = [&](Vector3 origin) {
        return surface_point(world->geometries[0], *world->intersector->nearest(origin, down, 10), origin,
                             down, nullptr);
      };
      const SurfacePoint point = point_at(from);
      const SurfacePoint x = point_at(from + Vector3{0.01, 0, 0}), y = point_at(from + step);
      const Vector3 along_v{x.v - point.v, y.v - point.v, 0}, along_u{x.u - point.u, y.u - point.u, 0};
      EXPECT_GT(dot(gltf.normal_at(point), along_v), 0) << uv << way;
      EXPECT_NEAR(dot(gltf.normal_at(point), along_u), 0, 1e-9) << uv << way;
      EXPECT_GT(dot(gltf.normal_at(point), point.normal), 0) << uv << way;
      EXPECT_GT(dot(pbrt.normal_at(point), cross(point.shading_normal, point.along_u)), 0) << uv << way;
    }
}

TEST(NormalMap, RefusesPicturesOfOneChannel) {
  const test::Scratch scratch;
  PngImage grey;
  grey.columns = grey.rows = 1, grey.channels = 1, grey.samples = {100};
  write_png(scratch.path("n.png"), grey);
  EXPECT_THROW(radiance(scratch.path("n.png"), {0, 0, 1}, true), InputError);
  EXPECT_THROW(radiance(scratch.path("none.png"), {0, 0, 1}, true), InputError);
}

}  // namespace
}  // namespace petzval::render
