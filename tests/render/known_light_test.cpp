// SPDX-License-Identifier: BSD-3-Clause
// Rendered light that photometry and geometry state beforehand.
#include <gtest/gtest.h>
#include <petzval/base/units.h>
#include <petzval/render/camera/perspective_camera.h>
#include <petzval/render/path_tracer.h>
#include <petzval/render/renderer.h>

#include <cmath>
#include <limits>
#include <string>

#include "scene_text.h"

namespace petzval::render {
namespace {

/// A white wall lit by a distant light at right angles: E/π through a pinhole of 1 sr; and how far it is.
TEST(KnownLight, LambertsWallHasTheRadianceThatPhotometrySays) {
  const auto world = world_of(
      "LightSource \"distant\" \"spectrum L\" [ 300 2 900 2 ] \"point3 from\" [ 0 0 0 ] \"point3 to\" [ 0 0 "
      "1 ]\n"
      "Material \"diffuse\" \"rgb reflectance\" [ .5 .5 .5 ]\n"
      "Shape \"trianglemesh\" \"point3 P\" [ -9 -9 3  9 -9 3  0 9 3 ] \"integer indices\" [ 0 1 2 ]\n");
  PerspectiveOptions perspective;
  perspective.columns = perspective.rows = 8;
  perspective.field_of_view_deg = 40;
  const PerspectiveCamera camera(perspective, world->groups);
  RenderOptions options;
  options.first_surfaces = true;
  const Rendering picture = render_picture(*world, camera, Transform(), {8, 8, 10}, options);
  for (const float value : picture.irradiance.values()) EXPECT_NEAR(value, 2 * 0.5 / pi, 1e-6);
  for (const float depth : picture.first_surfaces->depth) EXPECT_NEAR(depth, 3, 1e-5);
  for (const float albedo : picture.first_surfaces->albedo) EXPECT_NEAR(albedo, 0.5, 1e-6);
  for (std::size_t i = 2; i < picture.first_surfaces->normal.size(); i += 3)
    EXPECT_NEAR(picture.first_surfaces->normal[i], -1, 1e-6);
}

/// Three walls that glow, one behind the other: clipping planes stand across the axis, whatever the angle of
/// the ray.
TEST(KnownLight, SeesWhatLiesBetweenTheClippingPlanes) {
  std::string text;
  for (const int z : {1, 2, 3}) {
    const std::string at = std::to_string(z), side = std::to_string(20 * z);
    text += "AttributeBegin\nAreaLightSource \"diffuse\" \"spectrum L\" [ 200 " + at + " 900 " + at +
            " ] \"bool twosided\" true\nTranslate 0 0 " + at + "\nShape \"disk\" \"float radius\" " + side +
            "\nAttributeEnd\n";
  }
  const auto world = world_of(text);
  PerspectiveOptions perspective;
  perspective.columns = perspective.rows = 8;
  perspective.field_of_view_deg = 100;  // corners lie 59 degrees off the axis, where z = 2 is 3.9 away
  const PerspectiveCamera camera(perspective, world->groups);
  const auto seen = [&](double near, double far) {
    RenderOptions options;
    options.samples_per_pixel = 4;
    options.path.max_depth = 0;
    options.clipping = {near, far};
    const Rendering picture = render_picture(*world, camera, Transform(), {8, 8, 10}, options);
    for (const float value : picture.irradiance.values()) EXPECT_EQ(value, picture.irradiance.values()[0]);
    return picture.irradiance.values()[0];
  };
  constexpr double forever = std::numeric_limits<double>::infinity();
  EXPECT_NEAR(seen(0, forever), 1, 1e-6);
  EXPECT_NEAR(seen(1.01, forever), 2, 1e-6);
  EXPECT_NEAR(seen(2.01, 3.01), 3, 1e-6);
  EXPECT_NEAR(seen(2.01, 2.99), 0, 1e-6);
  EXPECT_NEAR(seen(0, 0.99), 0, 1e-6);
  EXPECT_EQ(seen(1e19, forever), 0);  // beyond where Embree takes rays
}

/// What a white wall at z = 3 sends back from the point (0, 0, 3), seen from the side, times π: the
/// irradiance there.
double irradiance_on_wall(const std::string& light) {
  const auto world = world_of("AttributeBegin\n" + light +
                              "AttributeEnd\nMaterial \"diffuse\" \"rgb reflectance\" [ 1 1 1 ]\n"
                              "Shape \"trianglemesh\" \"point3 P\" [ -9 -9 3  9 -9 3  0 9 3 ]");
  PathOptions path;
  path.max_depth = 1;
  const PathTracer tracer(*world, path);
  const Vector3 from{1.2, 0, 2.9}, to{0, 0, 3};
  double sum = 0;
  constexpr int samples = 4096;
  for (int i = 0; i < samples; ++i) {
    SobolSample sample(3, static_cast<std::uint32_t>(i));
    sum += static_cast<double>(tracer.trace(from, normalised(to - from), 0, 0, sample).shared[0]) / samples;
  }
  return pi * sum;
}

/// Lamps 2 in front of the wall, of radiance or intensity 3.
TEST(KnownLight, LightsGiveTheIrradianceOfTheirClosedForms) {
  const std::string area = "AreaLightSource \"diffuse\" \"spectrum L\" [ 300 3 900 3 ]\nTranslate 0 0 1\n";
  const std::string intensity = " \"spectrum I\" [ 300 3 900 3 ] \"point3 from\" [ 0 0 1 ]";
  const auto expect = [](const std::string& light, double expected) {
    EXPECT_NEAR(irradiance_on_wall(light), expected, 2e-3 * expected) << light;  // 4096 Sobol points
  };
  expect(area + "Shape \"disk\" \"float radius\" 0.5\n", pi * 3 * 0.25 / (4 + 0.25));  // π L sin²θ
  expect(area + "Shape \"sphere\" \"float radius\" 0.5\n", pi * 3 * 0.25 / 4);
  expect("LightSource \"point\"" + intensity + "\n", 3.0 / 4);
  expect("LightSource \"spot\"" + intensity + " \"point3 to\" [ 0 0 2 ]\n", 3.0 / 4);
}

/// One wavelength alone stands for as many as might have led: three here, where eight would fit.
TEST(KnownLight, SeesGlassThatDispersesAsBrightAsItIs) {
  const auto world =
      world_of(std::string(white_furnace) +
               "Material \"dielectric\" \"spectrum eta\" \"glass-SF11\"\nTranslate 0 0 3\nShape "
               "\"sphere\" \"float radius\" 1\n");
  PerspectiveOptions perspective;
  perspective.columns = perspective.rows = 4;
  perspective.field_of_view_deg = 10;
  RenderOptions options;
  options.samples_per_pixel = 2048;
  options.path.max_depth = 100;
  const Rendering picture = render_picture(*world, PerspectiveCamera(perspective, world->groups), Transform(),
                                           SensorGeometry{4, 4, 10}, options);
  // 32768 paths a band; of the third that a band leads, each counts three times: √2 of scatter.
  for (std::size_t band = 0; band < 3; ++band) {
    double sum = 0;
    for (std::size_t i = 0; i < 16; ++i)
      sum += static_cast<double>(picture.irradiance.values()[16 * band + i]) / 16;
    EXPECT_NEAR(sum, 1, 4.5 * std::sqrt(2.0 / 32768)) << band;
  }
}

}  // namespace
}  // namespace petzval::render
