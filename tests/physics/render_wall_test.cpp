// SPDX-License-Identifier: BSD-3-Clause
// What rendering through a lens must agree with: g_sensor of `lens illumination`, pbrt-v4's figures, the
// square of the stop, and rays traced one by one.
#include <gtest/gtest.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/analysis/ray_count.h>
#include <petzval/base/units.h>
#include <petzval/camera/mounted_lens.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_file.h>
#include <petzval/render/camera/lens_camera.h>
#include <petzval/render/renderer.h>

#include <cmath>

namespace petzval {
namespace {

using namespace render;

std::unique_ptr<const World> wall_world(const std::string& text, const std::vector<double>& wavelengths_nm) {
  Unsupported unsupported;
  return build_world(parse_scene_description("WorldBegin\n" + text, "test.pbrt", unsupported),
                     WavelengthGroups(wavelengths_nm), {true}, unsupported);
}

/// Light of radiance 1 at every wavelength from everywhere.
constexpr const char* wall_surround = "LightSource \"infinite\" \"spectrum L\" [ 200 1 900 1 ]\n";

struct Measured {
  std::vector<double> mean, standard_error;  ///< by band
};

/// The mean irradiance of the pixels up to `reach` around one, from independent renderings.
Measured patch(const World& world, const LensCamera& camera, const SensorGeometry& film, int column, int row,
               int reach, int samples, int renderings = 8) {
  const std::size_t bands = world.groups.wavelengths_nm().size();
  std::vector<double> sum(bands), squares(bands);
  for (int i = 0; i < renderings; ++i) {
    RenderOptions options;
    options.samples_per_pixel = samples;
    options.seed = static_cast<std::uint64_t>(100 + i);
    options.window = PixelWindow{column - reach, row - reach, column + reach + 1, row + reach + 1};
    const Rendering picture = render_picture(world, camera, Transform(), film, options);
    for (std::size_t b = 0; b < bands; ++b) {
      double value = 0;
      for (const float each : picture.irradiance.band(static_cast<int>(b)))
        value += static_cast<double>(each) / static_cast<double>(picture.irradiance.band_size());
      sum[b] += value, squares[b] += value * value;
    }
  }
  Measured result;
  for (std::size_t b = 0; b < bands; ++b) {
    const double mean = sum[b] / renderings, variance = std::max(0.0, squares[b] / renderings - mean * mean);
    result.mean.push_back(mean);
    result.standard_error.push_back(std::sqrt(variance / (renderings - 1)));
  }
  return result;
}

/// The film point at a height [mm] above the axis and a patch about it, of pixels so small that g_sensor does
/// not change over one.
struct FilmPoint {
  static constexpr double pitch_mm = 0.005;
  static constexpr int reach = 8;
  SensorGeometry film;
  int row;
  double height_mm;

  explicit FilmPoint(double wanted_mm)
      : film{2 * reach + 1, 2 * static_cast<int>(std::ceil(wanted_mm / pitch_mm)) + 2 * reach + 3, 5},
        row(static_cast<int>(std::lround(film.rows / 2.0 + wanted_mm / pitch_mm - 0.5))),
        height_mm(film.y_mm(row + 0.5)) {}

  Measured wall(const World& world, const LensCamera& camera, int samples) const {
    return patch(world, camera, film, reach, row, reach, samples);
  }
};

void expect_agreement(const Measured& wall, std::size_t band, double g, const std::string& where) {
  const double error = wall.standard_error[band];
  EXPECT_LT(error, 1e-3 * g) << where;
  EXPECT_NEAR(wall.mean[band], g, 3 * error + 2e-4 * g) << where;
}

/// Light through a lens onto a film point, for each wavelength, by both ways.
void expect_wall_is_g_sensor(const Lens& lens, double height_mm, const std::vector<double>& wavelengths_nm,
                             int samples = 32) {
  const auto world = wall_world(wall_surround, wavelengths_nm);
  const FilmPoint point(height_mm);
  const Measured wall = point.wall(*world, LensCamera(lens, point.film, world->groups), samples);
  for (std::size_t b = 0; b < wavelengths_nm.size(); ++b) {
    const Tracer tracer(lens, wavelengths_nm[b]);
    // Counting on a grid of directions knows nothing of pupils; its error is about 2 · 1500^−1.5 relative.
    const double g = counted_g_sensor_sr(tracer, std::abs(point.height_mm), 1500);
    expect_agreement(wall, b, g, lens.name + " at " + std::to_string(point.height_mm) + " mm");
  }
}

/// The same with losses, against `lens illumination`, which follows every ray of its quadrature through every
/// surface.
void expect_lossy_wall_is_g_sensor(const Lens& lens, double height_mm, const Losses& losses, int samples) {
  const std::vector<double> wavelengths{430, 550, 660};
  const auto world = wall_world(wall_surround, wavelengths);
  const FilmPoint point(height_mm);
  LensCameraOptions options;
  options.losses = losses;
  const Measured wall = point.wall(*world, LensCamera(lens, point.film, world->groups, options), samples);
  for (std::size_t b = 0; b < wavelengths.size(); ++b) {
    FieldTracer fields(lens, wavelengths[b]);
    fields.set_losses(losses);
    // Object angles and image heights go with, object heights against each other.
    const double height = lens.object_distance_mm ? -std::abs(point.height_mm) : std::abs(point.height_mm);
    const auto field = fields.object_field_at_image_height(height);
    ASSERT_TRUE(field) << lens.name << " at " << height;
    const auto chief = fields.chief_ray(*field);
    ASSERT_TRUE(chief);
    const double g = fields.g_sensor_sr(*chief);
    // Or the losses were not there: 0.2 % and more in every case.
    EXPECT_LT(g, 0.998 * counted_g_sensor_sr(fields.tracer(), std::abs(point.height_mm), 500));
    expect_agreement(wall, b, g, lens.name + " with losses at " + std::to_string(point.height_mm) + " mm");
  }
}

class WallThroughLens : public testing::TestWithParam<std::pair<const char*, std::vector<double>>> {};

TEST_P(WallThroughLens, IsGSensor) {
  const auto& [name, heights] = GetParam();
  const Lens lens = read_lens(name).lens;
  for (const double height : heights) expect_wall_is_g_sensor(lens, height, {486.1327, 587.5618});
}

INSTANTIATE_TEST_SUITE_P(CourseLenses, WallThroughLens,
                         testing::Values(std::pair{"dgauss-50mm", std::vector<double>{0, 10, 20}},
                                         std::pair{"wide-22mm", std::vector<double>{0, 8, 16}},
                                         std::pair{"telephoto-250mm", std::vector<double>{0, 20}},
                                         std::pair{"fisheye-10mm", std::vector<double>{0, 5, 10}}));

/// Real glass: the wavelengths of a group share their paths and land apart.
TEST(WallThroughLens, IsGSensorWithDispersion) {
  MountedLens camera(read_lens("edmund-54852").lens);
  for (const double height : {0.0, 1.4, 2.7})
    expect_wall_is_g_sensor(camera.lens(), height, {430, 550, 660}, 256);
}

TEST(WallThroughLens, IsGSensorWithLosses) {
  Losses bare, coated;
  bare.fresnel = bare.absorption = true;
  coated.air_glass = Coating{{{400, 0.02}, {700, 0.005}}};
  coated.surfaces[0] = Coating::constant(0.1);
  const Lens course = read_lens("dgauss-50mm").lens, dispersing = read_lens("edmund-54852").lens;
  for (const Losses& losses : {bare, coated}) {
    for (const double height : {0.0, 15.0}) expect_lossy_wall_is_g_sensor(course, height, losses, 32);
    for (const double height : {0.0, 2.7}) expect_lossy_wall_is_g_sensor(dispersing, height, losses, 256);
  }
}

/// Tilted and decentred: above and below the axis the wall differs, and each is what rays counted there say.
TEST(WallThroughLens, IsGSensorOfALensAsBuilt) {
  Lens lens = read_lens("dgauss-50mm").lens;
  lens.surfaces[3].pose.tilt_x_deg = 1.5;
  lens.groups = {{0, 1, {0, 1.2, 0, 2, 0, 0}, 0}};
  lens.sensor_pose.tilt_x_deg = 3;
  const auto world = wall_world(wall_surround, {550});
  const SensorGeometry film{17, 8017, 5};
  const LensCamera camera(lens, film, world->groups);
  std::vector<double> seen;
  for (const int row : {1008, 4008, 7008}) {
    const Measured wall = patch(*world, camera, film, 8, row, 8, 64);
    const double g = counted_g_sensor_sr(Tracer(lens, 550), film.y_mm(row + 0.5), 1500);
    expect_agreement(wall, 0, g, "row " + std::to_string(row));
    seen.push_back(g);
  }
  EXPECT_GT(std::abs(seen[0] / seen[2] - 1), 0.05) << "or nothing was shown";
}

/// What the lens lets through of light at a film point above the axis: the mean over directions on a grid
/// that pass.
double counted_transmittance(const Tracer& tracer, const LensTransmittance& losses, double y_mm) {
  constexpr int across = 400;
  constexpr double reach = 0.5;  // of the cosines
  double sum = 0;
  int passed = 0;
  std::vector<Intersection> path;
  for (int i = 0; i < across; ++i)
    for (int j = 0; j < across; ++j) {
      const double alpha = reach * (2 * (i + 0.5) / across - 1), beta = reach * (2 * (j + 0.5) / across - 1);
      const Ray start{{0, y_mm, tracer.image_z_mm()},
                      {alpha, beta, -std::sqrt(1 - alpha * alpha - beta * beta)}};
      path.clear();
      if (tracer.trace_backward(start, Tracer::Clip::apertures, &path).status != RayStatus::ok) continue;
      sum += losses.along(tracer.from_image(start), path, true), ++passed;
    }
  return sum / passed;
}

/// The same with losses, which are those of every ray.
TEST(WallThroughLens, IsGSensorOfALensAsBuiltWithLosses) {
  Lens lens = read_lens("dgauss-50mm").lens;
  lens.groups = {{0, 1, {0, 1.2, 0, 6, 0, 0}, 0}};
  lens.sensor_pose.tilt_x_deg = 3;
  LensCameraOptions options;
  options.losses.fresnel = true;
  options.losses.surfaces[0] = Coating::constant(0.1);
  const auto world = wall_world(wall_surround, {550});
  const SensorGeometry film{17, 8017, 5};
  const LensCamera camera(lens, film, world->groups, options);
  const Tracer tracer(lens, 550);
  const LensTransmittance losses(lens, 550, options.losses);
  for (const int row : {1008, 7008}) {
    const Measured wall = patch(*world, camera, film, 8, row, 8, 64);
    const double y = film.y_mm(row + 0.5), through = counted_transmittance(tracer, losses, y);
    EXPECT_LT(through, 0.8);
    expect_agreement(wall, 0, through * counted_g_sensor_sr(tracer, y, 1500), "row " + std::to_string(row));
  }
}

TEST(WallThroughLens, IsTheSameByTheSamplerOf2006) {
  LensCameraOptions options;
  options.sampling = LensCameraOptions::Sampling::rear_disk;
  const Lens lens = read_lens("dgauss-50mm").lens;
  const auto world = wall_world(wall_surround, {550});
  const SensorGeometry film{9, 1009, 20};
  const LensCamera camera(lens, film, world->groups, options);
  for (const int row : {504, 904}) {
    const Measured wall = patch(*world, camera, film, 4, row, 1, 512);
    const double g = counted_g_sensor_sr(Tracer(lens, 550), std::abs(film.y_mm(row + 0.5)), 1500);
    EXPECT_NEAR(wall.mean[0], g, 3 * wall.standard_error[0] + 2e-4 * g);
    EXPECT_LT(wall.standard_error[0], 3e-3 * g);
  }
}

/// pbrt-v4's irradiance over radiance at the middle of the film, at these stop diameters and distances from
/// the film. Its focus is that of a thick lens from two traced rays, ours paraxial.
TEST(WallThroughLens, AgreesWithPbrt) {
  struct Figure {
    const char* lens;
    double stop_mm, distance_m, ratio;
  };
  for (const Figure& figure :
       {Figure{"dgauss-50mm", 17.1, 1.75, 0.18434}, Figure{"wide-22mm", 8.756, 1.75, 0.09864},
        Figure{"telephoto-250mm", 40.5, 10, 0.02335}, Figure{"fisheye-10mm", 6.08, 1.75, 0.04903}}) {
    Lens lens = read_lens(figure.lens).lens;
    lens.aperture = {Aperture::Kind::stop_semi_diameter_mm, figure.stop_mm / 2};
    MountedLens camera(lens);
    camera.focus_at_m(figure.distance_m);
    const double g = counted_g_sensor_sr(Tracer(camera.lens(), 550), 0, 3000);
    EXPECT_NEAR(g / figure.ratio, 1, 1e-3) << figure.lens;
  }
}

TEST(Stop, HalfTheDiameterGivesAQuarterOfTheLight) {
  Lens open = read_lens("dgauss-50mm").lens, half = open;
  half.aperture.value = open.aperture.value / 2;
  const auto world = wall_world(wall_surround, {550});
  const SensorGeometry film{9, 9, 20};
  const double ratio = patch(*world, LensCamera(half, film, world->groups), film, 4, 4, 1, 256).mean[0] /
                       patch(*world, LensCamera(open, film, world->groups), film, 4, 4, 1, 256).mean[0];
  EXPECT_NEAR(ratio, 0.25, 0.01 * 0.25);
}

/// A tiny luminous disk far off the axis, through a lens of real glass: the centroid of each wavelength's
/// light lies where rays traced forward from the disk land.
TEST(PointOfLight, LandsWhereItsRaysLand) {
  const Lens lens = read_lens("edmund-54852").lens;  // object at 250 mm
  const std::vector<double> wavelengths{430, 550, 660};
  const double height_mm = 80, distance_mm = *lens.object_distance_mm;
  const double z_m = (lens.total_track_mm() + distance_mm) * 1e-3;
  char text[200];
  std::snprintf(text, sizeof text,
                "AreaLightSource \"diffuse\" \"spectrum L\" [ 200 1 900 1 ]\nTranslate 0 %.9g %.9g\nRotate "
                "180 0 1 0\nShape \"disk\" \"float "
                "radius\" 0.0002",
                height_mm * 1e-3, z_m);
  const auto world = wall_world(text, wavelengths);
  // The image of a point above the axis lies below it: in the picture it is above the middle.
  const SensorGeometry film{240, 2000, 2.5};
  const LensCamera camera(lens, film, world->groups);
  RenderOptions options;
  options.samples_per_pixel = 64;
  const double m = first_order(lens).magnification;
  const int row = static_cast<int>(film.rows / 2.0 + 0.9 * m * height_mm * 1e3 / film.pitch_um);
  options.window = PixelWindow{100, row - 60, 140, row + 60};
  const Rendering picture = render_picture(*world, camera, Transform(), film, options);
  for (std::size_t b = 0; b < wavelengths.size(); ++b) {
    double sum = 0, rows = 0, columns = 0;
    for (int r = 0; r < picture.irradiance.rows(); ++r)
      for (int c = 0; c < picture.irradiance.columns(); ++c) {
        const double value = static_cast<double>(picture.irradiance.at(static_cast<int>(b), r, c));
        sum += value, rows += value * (r + 0.5), columns += value * (c + 0.5);
      }
    ASSERT_GT(sum, 0);
    // Forward: even over the directions of the object point that pass.
    const Tracer tracer(lens, wavelengths[b]);
    double y_sum = 0;
    int passed = 0;
    const PupilData pupil = first_order(lens).entrance_pupil;
    for (int i = 0; i < 200; ++i)
      for (int j = 0; j < 200; ++j) {
        const double x = pupil.diameter_mm * ((i + 0.5) / 200 - 0.5) * 1.5,
                     y = pupil.diameter_mm * ((j + 0.5) / 200 - 0.5) * 1.5;
        const Vector3 from{0, height_mm, -distance_mm}, to{x, y, pupil.position_mm};
        const Vector3 d = normalised(to - from);
        const Ray ray = tracer.trace(Ray{{from.x, from.y, from.z}, {d.x, d.y, d.z}});
        if (ray.status != RayStatus::ok) continue;
        y_sum += ray.point_mm[1];
        ++passed;
      }
    ASSERT_GT(passed, 100);
    const double expected_row = film.rows / 2.0 + y_sum / passed / (film.pitch_um * mm_per_um);
    // A twentieth of a pixel: the noise of the centroid of some thousand paths.
    EXPECT_NEAR(options.window->top + rows / sum, expected_row, 0.1) << wavelengths[b];
    EXPECT_NEAR(options.window->left + columns / sum, film.columns / 2.0, 0.1) << wavelengths[b];
  }
}

}  // namespace
}  // namespace petzval
