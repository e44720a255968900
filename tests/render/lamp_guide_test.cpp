// SPDX-License-Identifier: BSD-3-Clause
// Small lamps out of focus: the same picture with less noise.
#include <gtest/gtest.h>
#include <petzval/camera/mounted_lens.h>
#include <petzval/lens/lens_file.h>
#include <petzval/render/camera/lens_camera.h>
#include <petzval/render/lamps.h>
#include <petzval/render/renderer.h>

#include <cmath>
#include <numeric>

#include "scene_text.h"

namespace petzval::render {
namespace {

/// Three lamps of 4 and 6 mm, 4 to 7 m away, and a weak sky: one about the axis, one half way to the corner,
/// one before the other.
constexpr const char* street =
    "LightSource \"infinite\" \"rgb L\" [ .001 .001 .001 ]\n"
    "AttributeBegin\nAreaLightSource \"diffuse\" \"float scale\" 180\nTranslate .1 .05 5\nShape \"sphere\" "
    "\"float radius\" 0.004\nAttributeEnd\n"
    "AttributeBegin\nAreaLightSource \"diffuse\" \"float scale\" 90\nTranslate .9 .5 4\nShape \"sphere\" "
    "\"float radius\" 0.004\nAttributeEnd\n"
    "AttributeBegin\nAreaLightSource \"diffuse\" \"float scale\" 135\nTranslate .2 .05 7\nShape \"disk\" "
    "\"float radius\" 0.006\nAttributeEnd\n";

struct Street {
  std::unique_ptr<const World> world = world_of(street, {450, 550, 650});
  SensorGeometry film{96, 64, 375};
  Lens lens = [] {
    MountedLens mounted(read_lens("dgauss-50mm").lens);
    mounted.focus_at_m(0.8);
    return mounted.lens();
  }();

  LensCamera camera(bool guided) const {
    LensCameraOptions options;
    if (guided) options.lamps = lamps_of(*world, Transform());
    return LensCamera(lens, film, world->groups, options);
  }
  Rendering render(bool guided, int samples, std::uint64_t seed) const {
    RenderOptions options;
    options.samples_per_pixel = samples, options.seed = seed;
    return render_picture(*world, camera(guided), Transform(), film, options);
  }
};

/// Of each pixel, over pictures of many seeds: mean, and variance of one picture, both of one band.
struct Moments {
  std::vector<double> mean, variance;
};

Moments moments(const Street& street, bool guided, int samples) {
  constexpr int pictures = 32;
  Moments result;
  for (int seed = 1; seed <= pictures; ++seed) {
    const Rendering picture = street.render(guided, samples, static_cast<std::uint64_t>(seed));
    const std::span<const float> plane = picture.irradiance.band(1);
    result.mean.resize(plane.size()), result.variance.resize(plane.size());
    for (std::size_t i = 0; i < plane.size(); ++i) {
      const auto value = static_cast<double>(plane[i]);
      result.mean[i] += value / pictures, result.variance[i] += value * value / pictures;
    }
  }
  for (std::size_t i = 0; i < result.mean.size(); ++i)
    result.variance[i] = (result.variance[i] - result.mean[i] * result.mean[i]) * pictures / (pictures - 1);
  return result;
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

TEST(LampGuide, KeepsTheMeanAndTakesTheNoise) {
  const Street street;
  ASSERT_EQ(lamps_of(*street.world, Transform()).size(), 3u);
  const Moments plain = moments(street, false, 64), guided = moments(street, true, 16);
  // All light: within three standard deviations of the difference of the means of 32 pictures.
  const double deviation = std::sqrt((sum(plain.variance) + sum(guided.variance)) / 32);
  EXPECT_NEAR(sum(guided.mean), sum(plain.mean), 3 * deviation);
  EXPECT_GT(sum(plain.mean), 10 * deviation);  // which is no wide bound
  // The lamps are less than a hundredth of the pupil, and ellipses up to four times as large as the lamp are
  // found in half of the samples: 1/p − 1 falls from 100 or more to 7, with a quarter of the samples besides.
  EXPECT_LT(sum(guided.variance), 4 * 0.15 * sum(plain.variance));
}

TEST(LampGuide, LeavesLampsInFocusAlone) {
  Street street;
  MountedLens mounted(read_lens("dgauss-50mm").lens);
  mounted.focus_at_m(5);
  street.lens = mounted.lens();
  // The lamp in focus fills the pupil: half of the directions towards it would be lost.
  const ExitPupilRegions pupil(std::array{Tracer(street.lens, 550)}, street.film.half_diagonal_mm());
  const std::array<Lamp, 1> sharp{Lamp{{0.1, 0.05, 5}, 0.012, 1}}, near{Lamp{{0.1, 0.05, 0.8}, 0.001, 1}};
  const std::array tracers{Tracer(street.lens, 550)};
  const LensPlace place{1e-3, Tracer(street.lens, 550).image_z_mm()};
  const LampGuide of_sharp(sharp, tracers, place, street.film, 0, pupil);
  const LampGuide of_near(near, tracers, place, street.film, 0, pupil);
  bool any = false;
  for (double x = -18; x <= 18; x += 0.25)
    for (double y = -12; y <= 12; y += 0.25) {
      EXPECT_FALSE(of_sharp.concerns(x, y)) << x << " " << y;
      any = any || of_near.concerns(x, y);
    }
  EXPECT_TRUE(any);
}

TEST(LampGuide, SendsRaysToTheLamp) {
  const Street street;
  const Lamp lamp{{0.1, 0.05, 5}, 0.012, 1};
  const Tracer tracer(street.lens, 550);
  const auto disk = LampDisk::find(lamp, std::array{tracer}, {1e-3, tracer.image_z_mm()});
  ASSERT_TRUE(disk);
  // From nine places of its disk the rays through the middle of the ellipse pass the lamp's middle by less
  // than its radius.
  for (const double u : {-0.5, 0.0, 0.5})
    for (const double v : {-0.5, 0.0, 0.5}) {
      const double x = disk->x_mm() + u * disk->radius_mm(), y = disk->y_mm() + v * disk->radius_mm();
      const auto [alpha, beta] = disk->direction(x, y, 0, 0);
      const Ray ray = tracer.trace_backward(
          {{x, y, tracer.image_z_mm()}, {-alpha, -beta, -std::sqrt(1 - alpha * alpha - beta * beta)}},
          Tracer::Clip::none);
      const double z = tracer.image_z_mm() - 5000;  // of the lamp, in the space of the lens
      const double along = (z - ray.point_mm[2]) / ray.direction[2];
      EXPECT_NEAR(ray.point_mm[0] + along * ray.direction[0], 100, 12);
      EXPECT_NEAR(ray.point_mm[1] + along * ray.direction[1], 50, 12);
    }
}

TEST(LampGuide, HasNoEllipseInFocus) {
  // In focus, light of a lamp's middle lands on one point, and that of its rim far from it.
  const Street street;
  const Tracer tracer(street.lens, 550);
  const double in_focus_m = 0.8;
  const auto disk_at = [&](double metres, double radius_m) {
    return LampDisk::find(Lamp{{0.1, 0.05, metres}, radius_m, 1}, std::array{tracer},
                          {1e-3, tracer.image_z_mm()});
  };
  for (const double metres : {0.98 * in_focus_m, in_focus_m, 1.02 * in_focus_m})
    for (const double radius_m : {0.002, 0.02, 0.06})
      EXPECT_FALSE(disk_at(metres, radius_m)) << metres << " " << radius_m;
  const auto blurred = disk_at(4 * in_focus_m, 0.002);
  ASSERT_TRUE(blurred);
  EXPECT_GT(blurred->area_sr(), 0);
}

}  // namespace
}  // namespace petzval::render
