// SPDX-License-Identifier: BSD-3-Clause
// PSFs at the depths of a three-dimensional scene.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <petzval/dataset/pixel_psfs.h>
#include <petzval/lens/lens_file.h>
#include <petzval/simulate/chief_rays.h>
#include <petzval/simulate/image.h>

#include <cmath>

#include "scratch.h"

namespace petzval {
namespace {

using test::Scratch;

Camera camera_of(int columns, int rows, double pitch_um) {
  Camera camera{.lens = read_lens("dgauss-50mm").lens};
  camera.focus = Focus::at_m(2);
  camera.sensor.emplace();
  camera.sensor->geometry.columns = columns, camera.sensor->geometry.rows = rows;
  camera.sensor->geometry.pitch_um = pitch_um;
  return camera;
}

PreparedScene prepared(const Scratch& scratch, const Camera& camera, const std::string& shapes) {
  RenderRequest request{.scene = scratch.with("world.pbrt",
                                              "LookAt 0 0 0  0 0 1  0 1 0\n"
                                              "Camera \"perspective\" \"float fov\" 30\n"
                                              "WorldBegin\n" +
                                                  shapes)};
  request.camera = camera;
  request.wavelengths_nm = {550};
  request.samples_per_pixel = 64;
  return prepare_scene(request);
}

const char* const wall = "Shape \"bilinearmesh\" \"point3 P\" [ -9 -9 2   9 -9 2   -9 9 2   9 9 2 ]\n";

/// Standard deviation along the columns, in pixels, of some light.
template <typename Value>
double spread(int columns, int rows, const Value& value) {
  double sum = 0, first = 0, second = 0;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const double light = value(column, row);
      sum += light, first += light * column, second += light * column * column;
    }
  return std::sqrt(second / sum - first * first / (sum * sum));
}

// Small lamps at 1 m and 3 m, the lens focused at 2 m, path-traced: their pictures are as wide as the PSFs of
// their places, a disc of the lamp's radius (R/2 along an axis) added. 350 paths and more find a lamp, which
// leaves 2 % of the width; 5 % are allowed. Pixels are so small that it does not matter where in one a centre
// lies. A PSF of what is in focus would be a tenth as wide.
TEST(WorldPsfs, AreAsWideAsThePicturesOfLampsAtTheirDepths) {
  const Scratch scratch;
  const Camera camera = camera_of(96, 48, 25);
  constexpr double radius_m = 0.002;
  const ChiefRays rays(prepared(scratch, camera, wall));
  std::string lamps = "AreaLightSource \"diffuse\" \"rgb L\" [ 1 1 1 ]\n";
  std::array<double, 2> radius_px{};
  for (const int lamp : {0, 1}) {
    const render::CameraRay ray = rays.trace({{24.0 + 48 * lamp, 24.0}}).front();
    const double z = lamp == 0 ? 1 : 3, along = (z - ray.origin.z) / ray.direction.z;
    lamps += fmt::format(
        "AttributeBegin\nTranslate {} {} {}\nShape \"sphere\" \"float radius\" {}\nAttributeEnd\n",
        ray.origin.x + along * ray.direction.x, ray.origin.y + along * ray.direction.y, z, radius_m);
    radius_px[static_cast<std::size_t>(lamp)] = radius_m / z * 51.6 / 0.025;
  }
  const PreparedScene scene = prepared(scratch, camera, lamps);
  const SpectralImage light = render_scene(scene).irradiance;
  constexpr int size = 31;
  const PixelPsfs psfs = pixel_psfs(scene, 1, 2, size);
  for (const int lamp : {0, 1}) {
    const float* psf = psfs.values.data() + lamp * size * size;
    const double seen = spread(48, 48,
                               [&](int column, int row) {
                                 return static_cast<double>(light.at(0, row, column + 48 * lamp));
                               }),
                 told = spread(size, size, [&](int column, int row) {
                   return static_cast<double>(psf[row * size + column]);
                 });
    EXPECT_GT(told, 0.4);
    EXPECT_NEAR(seen, std::hypot(told, radius_px[static_cast<std::size_t>(lamp)] / 2), 0.05 * seen) << lamp;
  }
}

// A wall in three dimensions is a flat scene: the same PSFs within the 2 % that interpolation between the
// fields of the table may cost. Far from the axis they have a head and a tail: mirrored ones differ by
// several times that.
TEST(WorldPsfs, OfAWallAreThoseOfAFlatScene) {
  const Scratch scratch;
  Camera camera = camera_of(3000, 2000, 8);
  camera.defocus_mm = 0.1;
  const PixelPsfs in_world = pixel_psfs(prepared(scratch, camera, wall), 2, 2, 25);
  SceneRequest scene{.name = "grid"};
  scene.options.wavelengths_nm = {550};
  scene.options.distance_m = 2;
  const ImagePlan plan = plan_image(scene, camera);
  const PixelPsfs flat = pixel_psfs(plan.table, plan.frame, {550}, 2, 2, 25);
  ASSERT_EQ(in_world.values.size(), flat.values.size());
  for (std::size_t place = 0; place < 4; ++place) {
    double apart = 0, mirrored = 0, upside_down = 0, all = 0;
    for (std::size_t i = 0; i < 25; ++i)
      for (std::size_t j = 0; j < 25; ++j) {
        const auto at = [&](std::size_t row, std::size_t column) {
          return static_cast<double>(flat.values[place * 625 + row * 25 + column]);
        };
        const double here = static_cast<double>(in_world.values[place * 625 + i * 25 + j]);
        all += at(i, j), apart += std::abs(here - at(i, j));
        mirrored += std::abs(here - at(i, 24 - j)), upside_down += std::abs(here - at(24 - i, j));
      }
    EXPECT_GT(all, 0.9);
    EXPECT_LT(apart, 0.02 * all);
    EXPECT_GT(mirrored, 0.06 * all);
    EXPECT_GT(upside_down, 0.06 * all);
  }
}

}  // namespace
}  // namespace petzval
