// SPDX-License-Identifier: BSD-3-Clause
// What the shape and size of the stop do to pictures.
#include <gtest/gtest.h>
#include <petzval/analysis/pupil_rays.h>
#include <petzval/camera/mounted_lens.h>
#include <petzval/lens/lens_file.h>
#include <petzval/render/camera/lens_camera.h>
#include <petzval/render/renderer.h>

#include <array>
#include <cmath>
#include <vector>

namespace petzval {
namespace {

using namespace render;

std::unique_ptr<const World> world_of(const std::string& text) {
  Unsupported unsupported;
  return build_world(parse_scene_description("WorldBegin\n" + text, "test.pbrt", unsupported),
                     WavelengthGroups({550}), {true}, unsupported);
}

/// Radiance 1 at every wavelength.
constexpr const char* surround = "LightSource \"infinite\" \"spectrum L\" [ 200 1 900 1 ]\n";
constexpr const char* far_point =
    "AreaLightSource \"diffuse\" \"spectrum L\" [ 200 1 900 1 ] \"bool twosided\" true\n"
    "Translate 0 0 20\nShape \"disk\" \"float radius\" 0.015\n";

Lens with_blades(Lens lens, const StopBlades& blades) {
  lens.surfaces[lens.stop_index()].blades = blades;
  return lens;
}

double wall(const Lens& lens, const StopBlades& blades = {}) {
  const auto world = world_of(surround);
  const SensorGeometry film{9, 9, 20};
  RenderOptions options;
  options.samples_per_pixel = 1024;
  const Rendering picture = render_picture(*world, LensCamera(with_blades(lens, blades), film, world->groups),
                                           Transform(), film, options);
  double sum = 0;
  for (const float value : picture.irradiance.values()) sum += static_cast<double>(value) / 81;
  return sum;
}

Lens stopped_down(double times) {
  Lens lens = read_lens("dgauss-50mm").lens;
  lens.aperture.value /= times;
  return lens;
}

TEST(Stop, LightGoesWithTheSquareOfItsDiameterDownToTheSmallest) {
  const double at_f8 = wall(stopped_down(4));
  for (const double times : {2.0, 8.0, 32.0})
    // Sine and tangent part by 0.4 % at f/8, and not at all farther down.
    EXPECT_NEAR(wall(stopped_down(4 * times)) / at_f8, 1 / (times * times), 0.01 / (times * times)) << times;
}

/// On the axis the pupil is the image of the stop: light goes with its area.
TEST(Stop, BladesTakeTheirShareOfTheLight) {
  const Lens lens = stopped_down(4);
  const double round = wall(lens);
  for (const StopBlades& blades : {StopBlades{3, 0}, StopBlades{5, 20}, StopBlades{8, 0}})
    // 8e4 samples of which a share passes: a standard error of 0.3 % at most, less as they are stratified.
    EXPECT_NEAR(wall(lens, blades) / round, blades.area_share(), 0.004) << blades.count;
}

struct Spot {
  double area = 0;                ///< pixels brighter than half of the brightest tenth
  double skew_x = 0, skew_y = 0;  ///< third central moments, to the right and up
};

/// A far point of light on a film `beyond_mm` behind its image.
Spot spot(const StopBlades& blades, double beyond_mm) {
  MountedLens camera(stopped_down(2));
  camera.focus_at_m(20);
  camera.move_sensor_mm(beyond_mm);
  const auto world = world_of(far_point);
  const SensorGeometry film{45, 45, 20};
  RenderOptions render;
  render.samples_per_pixel = 1024;
  render.path.max_depth = 0;
  const Rendering picture = render_picture(
      *world, LensCamera(with_blades(camera.lens(), blades), film, world->groups), Transform(), film, render);
  // Some 15 hits a pixel: half of the mean of the middle is 3 standard deviations away.
  double level = 0;
  for (int i = -2; i <= 2; ++i)
    for (int j = -2; j <= 2; ++j)
      level += static_cast<double>(picture.irradiance.at(0, 22 + i, 22 + j)) / 25 / 2;
  Spot result;
  double x_mean = 0, y_mean = 0;
  std::vector<std::array<double, 2>> lit;
  for (int row = 0; row < film.rows; ++row)
    for (int column = 0; column < film.columns; ++column)
      if (static_cast<double>(picture.irradiance.at(0, row, column)) > level)
        lit.push_back({column + 0.5, -(row + 0.5)});
  result.area = static_cast<double>(lit.size());
  for (const auto& [x, y] : lit) x_mean += x / result.area, y_mean += y / result.area;
  for (const auto& [x, y] : lit)
    result.skew_x += std::pow(x - x_mean, 3) / result.area,
        result.skew_y += std::pow(y - y_mean, 3) / result.area;
  return result;
}

/// A point out of focus is spread over the image of the stop: blades show, and which way they are turned.
TEST(Stop, BladesShowInTheSpreadOfADefocusedPoint) {
  const double beyond_mm = 2.5;  // 0.6 mm wide at f/4, 30 pixels
  const Spot round = spot({}, beyond_mm);
  ASSERT_NEAR(round.area, 725, 60);  // 2.5/54 of an exit pupil of 13.27 mm
  const Spot up = spot({3, 0}, beyond_mm);
  for (const int count : {3, 6}) {
    const Spot polygon = count == 3 ? up : spot({count, 0}, beyond_mm);
    // The lamp's image, 4 pixels wide, rounds the corners: 1 % of a triangle. Noise makes another per cent.
    EXPECT_NEAR(polygon.area / round.area, (StopBlades{count, 0}.area_share()), 0.03) << count;
  }
  // A triangle with a corner up is skewed upwards. The picture is upright, so light that entered high up
  // lands high in a picture whose film stands behind the focus: it has crossed the axis.
  const Spot left = spot({3, 90}, beyond_mm), before = spot({3, 0}, -beyond_mm);
  // A triangle's third moment along its height, over the cube of its height: 1/135.
  const double height = 1.5 * std::sqrt(round.area / M_PI), skew = height * height * height / 135;
  EXPECT_NEAR(up.skew_y / skew, 1, 0.2);
  EXPECT_NEAR(up.skew_x / skew, 0, 0.1);
  EXPECT_NEAR(left.skew_x / skew, -1, 0.2);
  EXPECT_NEAR(left.skew_y / skew, 0, 0.1);
  EXPECT_LT(before.skew_y / skew, -0.5);
}

/// The image of a point out of focus, rendered, has the moments of the rays of `lens spots`: same blades,
/// same sense of rotation, same light.
TEST(Stop, BladedSpotsOfLensAndRendererAgree) {
  const StopBlades blades{3, 25};
  MountedLens camera(stopped_down(2));
  camera.focus_at_m(20);
  camera.move_sensor_mm(2.5);
  camera.set_blades(blades);
  const auto world = world_of(far_point);
  const SensorGeometry film{45, 45, 20};
  RenderOptions render;
  render.samples_per_pixel = 4096;
  render.path.max_depth = 0;
  const Rendering picture =
      render_picture(*world, LensCamera(camera.lens(), film, world->groups), Transform(), film, render);
  // The picture is upright: on the film, x' = −(column − W/2) and y' = row − H/2 (docs/CONVENTIONS.md).
  std::vector<std::array<double, 3>> lit, rays;
  for (int row = 0; row < film.rows; ++row)
    for (int column = 0; column < film.columns; ++column)
      lit.push_back({-(column - 22) * 0.02, (row - 22) * 0.02,
                     static_cast<double>(picture.irradiance.at(0, row, column))});
  Lens far = camera.lens();
  far.object_distance_mm = 20e3 - far.total_track_mm();
  far.fields = {Fields::Kind::object_height_mm, {0}};
  FieldTracer tracer(far, 550);
  for (const PupilRay& ray : pupil_rays(tracer, *tracer.chief_ray(0)))
    rays.push_back({ray.x_mm, ray.y_mm, ray.entrance_measure});
  struct Moments {
    double x = 0, y = 0, xx = 0, yy = 0, xxx = 0, yyy = 0;
  };
  const auto moments = [](const std::vector<std::array<double, 3>>& light) {
    double all = 0;
    Moments m;
    for (const auto& [x, y, w] : light) all += w, m.x += w * x, m.y += w * y;
    m.x /= all, m.y /= all;
    for (const auto& [x, y, w] : light) {
      m.xx += w * std::pow(x - m.x, 2) / all, m.yy += w * std::pow(y - m.y, 2) / all;
      m.xxx += w * std::pow(x - m.x, 3) / all, m.yyy += w * std::pow(y - m.y, 3) / all;
    }
    return m;
  };
  const Moments seen = moments(lit), spots = moments(rays);
  // The lamp's disc of 37 µm radius and the pixel of 20 µm add their own second moments, and no third ones.
  const double lamp = 0.015 * 50 / 20, own = lamp * lamp / 4 + 0.02 * 0.02 / 12;
  const double size = std::sqrt(spots.xx);
  // 130,000 hits: second moments to 0.4 %, third to 1 % of size³, three standard errors; the lamp's image by
  // the focal length is 1 % uncertain.
  EXPECT_NEAR((seen.xx - own) / spots.xx, 1, 0.015);
  EXPECT_NEAR((seen.yy - own) / spots.yy, 1, 0.015);
  EXPECT_NEAR(seen.x, spots.x, 0.01 * size);
  EXPECT_NEAR(seen.y, spots.y, 0.01 * size);
  EXPECT_GT(std::abs(spots.xxx), 0.1 * size * size * size) << "else nothing is tested";
  EXPECT_NEAR(seen.xxx / (size * size * size), spots.xxx / (size * size * size), 0.02);
  EXPECT_NEAR(seen.yyy / (size * size * size), spots.yyy / (size * size * size), 0.02);
}

}  // namespace
}  // namespace petzval
