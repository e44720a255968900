// SPDX-License-Identifier: BSD-3-Clause
// The lights of a scene as sources of ghosts: their light and place against closed forms and against the
// picture that paths through the lens make of them.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/lens_file.h>
#include <petzval/simulate/image.h>
#include <petzval/simulate/render.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "scratch.h"

namespace petzval {
namespace {

/// A ball of radius 50 mm and radiance 2 W·m⁻²·sr⁻¹·nm⁻¹ to the right and above.
const char* const ball_scene = R"(
LookAt 0 0 0  0 0 1  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 90 "integer yresolution" 60 "float diagonal" 43.3
WorldBegin
AttributeBegin
  AreaLightSource "diffuse" "spectrum L" [ 400 2 700 2 ]
  Translate 0.4 0.2 3
  Shape "sphere" "float radius" 0.05
AttributeEnd
)";

struct LitScene {
  test::Scratch folder;
  RenderRequest request;

  explicit LitScene(const std::string& text) {
    request.scene = folder.with("ball.pbrt", text);
    request.camera.lens = read_lens("dgauss-50mm").lens;
    request.camera.focus = Focus::at_m(3.0);
    request.wavelengths_nm = {550};
    request.absolute_spectra = true;
    request.samples_per_pixel = 256;
  }
};

struct LightInFrame {
  double flux = 0, column = 0, row = 0;
};

LightInFrame light_in(const SpectralImage& image) {
  LightInFrame sum;
  for (int row = 0; row < image.rows(); ++row)
    for (int column = 0; column < image.columns(); ++column) {
      const double value = image.at(0, row, column);
      sum.flux += value, sum.column += value * (column + 0.5), sum.row += value * (row + 0.5);
    }
  sum.column /= sum.flux, sum.row /= sum.flux;
  return sum;
}

TEST(SceneFlare, TakesALampAsTheLensSeesIt) {
  LitScene scene(ball_scene);
  const PreparedScene prepared = prepare_scene(scene.request);
  FlareOptions options;
  options.ghosts = true;
  const FlareLayers layers = scene_flare(prepared, options);
  ASSERT_EQ(layers.sources.size(), 1U);
  const BrightSource& source = layers.sources[0];
  const double vertex_m = prepared.lens->total_track_mm() * 1e-3, ahead = 3 - vertex_m;
  EXPECT_NEAR(source.right, 0.4 / ahead, 1e-3);
  EXPECT_NEAR(source.up, 0.2 / ahead, 1e-3);
  // An even ball: π L sin² of its half angle; 256 points of it are within a per cent.
  const double distance_sq = 0.4 * 0.4 + 0.2 * 0.2 + ahead * ahead;
  EXPECT_NEAR(source.irradiance[0] / (pi * 2 * 0.05 * 0.05 / distance_sq), 1, 0.01);
  EXPECT_NEAR(source.radius_rad / std::asin(0.05 / std::sqrt(distance_sq)), 1, 0.01);
  ASSERT_TRUE(layers.ghosts);
  EXPECT_GT(light_in(*layers.ghosts).flux, 0);

  // The picture that paths make of the lamp: noise of 256 samples a pixel, a per cent over its pixels.
  const LightInFrame picture = light_in(render_scene(prepared).irradiance);
  const LightInFrame rays = light_in(straight_light(*prepared.lens, prepared.film, {550}, {&source, 1}));
  EXPECT_NEAR(rays.flux / picture.flux, 1, 0.04);
  EXPECT_NEAR(rays.column, picture.column, 0.3);
  EXPECT_NEAR(rays.row, picture.row, 0.3);
  EXPECT_GT(rays.column, 45);
  EXPECT_LT(rays.row, 30);
}

// A wall stands before all of it.
TEST(SceneFlare, SeesNoLampBehindAWall) {
  LitScene scene(std::string(ball_scene) +
                 "Shape \"bilinearmesh\" \"point3 P\" [ -9 -9 2  9 -9 2  -9 9 2  9 9 2 ]\n");
  const PreparedScene prepared = prepare_scene(scene.request);
  FlareOptions options;
  options.ghosts = true;
  options.suns.push_back({});
  const FlareLayers layers = scene_flare(prepared, options);
  EXPECT_TRUE(layers.sources.empty());
  EXPECT_FALSE(layers.suns);
}

TEST(SceneFlare, IsAddedToALayerOfTheSameFrameAlone) {
  FlareLayers layers;
  layers.ghosts = SpectralImage(3, 2, {550}, 10);
  layers.ghosts->at(0, 1, 2) = 4;
  SpectralImage light(3, 2, {550}, 10);
  light.at(0, 1, 2) = 1;
  add_layers(layers, light);
  EXPECT_EQ(light.at(0, 1, 2), 5);
  SpectralImage other(3, 2, {600}, 10);
  EXPECT_THROW(add_layers(layers, other), InputError);
}

// A sun in the picture of a dark wall has the illuminance that was asked for: its light over the pupil's
// area across it. The black body of 5772 K in a single band stands for 1 nm there.
TEST(SunInAPicture, IsWrittenAsDegreesAndLux) {
  const Sun sun = parse_sun("20,-5.5:80000");
  EXPECT_EQ(sun.right_deg, 20);
  EXPECT_EQ(sun.up_deg, -5.5);
  EXPECT_EQ(sun.illuminance_lx, 80000);
  EXPECT_EQ(parse_sun("1,2").illuminance_lx, 100000);
  for (const char* wrong : {"", "1", "1,", "a,b", "1,2:", "1:2,3", "1,2,3"})
    EXPECT_THROW(parse_sun(wrong), InputError) << wrong;
  // Twice the illuminance is twice the light.
  const double one = parse_sun("0,0:1000").at({500, 600}).irradiance[0];
  EXPECT_NEAR(parse_sun("0,0:2000").at({500, 600}).irradiance[0] / one, 2, 1e-12);
}

// The sources of a scene on a plane and of a panorama: one sample at a known place.
TEST(SceneSources, AreWhereTheSampleIs) {
  Scene plane(9, 5, {550}, 40, {});
  std::ranges::fill(plane.band(0), 1e-3F);
  plane.band(0)[1 * 9 + 7] = 500;  // three to the right, one up
  const SourcesFound found = find_sources(plane, 60, {10, 16});
  ASSERT_EQ(found.sources.size(), 1U);
  const double step = 2 * std::tan(radians(20)) / 9;
  EXPECT_NEAR(found.sources[0].right, 3 * step, 1e-9);
  EXPECT_NEAR(found.sources[0].up, step, 1e-9);
  const double cosine = 1 / std::sqrt(1 + 10 * step * step);
  EXPECT_NEAR(found.sources[0].irradiance[0] / (500 * step * step * std::pow(cosine, 3)), 1, 1e-9);

  Scene all(72, 36, {550}, 100, {});
  std::ranges::fill(all.band(0), 1e-3F);
  all.band(0)[12 * 72 + 44] = 500;  // latitude 27.5, longitude 42.5 degrees
  all.make_panorama({40, 20});
  const SourcesFound there = find_sources(all, 60, {10, 16});
  ASSERT_EQ(there.sources.size(), 1U);
  // By the angle to the axis of the camera, which points at longitude 40 and latitude 20.
  const double between = std::acos(std::sin(radians(27.5)) * std::sin(radians(20)) +
                                   std::cos(radians(27.5)) * std::cos(radians(20)) * std::cos(radians(2.5)));
  EXPECT_NEAR(std::atan(std::hypot(there.sources[0].right, there.sources[0].up)), between, 1e-9);
  EXPECT_GT(there.sources[0].right, 0);
  EXPECT_GT(there.sources[0].up, 0);
}

}  // namespace
}  // namespace petzval
