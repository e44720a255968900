// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/imaging/image_formation.h>
#include <petzval/imaging/scene_aim.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <vector>

#include "synthetic_table.h"

namespace petzval {
namespace {

Scene far_scene() {
  return {400, 300, {550}, 40, {}};
}

// A point of the plane is a direction; one is turned against the camera by matrices, the other is asked for.
TEST(SceneAim, ATurnedCameraSeesThePlaneByCentralProjection) {
  const Scene scene = far_scene();
  const double pan = radians(7), pitch = radians(-4), per_sample = scene.tangent_per_sample();
  const AimedPlane aimed({.pan_deg = 7, .pitch_deg = -4}, scene);
  for (const double right : {-150.0, 0.0, 30.0, 180.0})
    for (const double down : {-120.0, 10.0, 140.0}) {
      const AimedPlane::Place place = aimed.at(right, down);
      // Back: from the plane's direction to the camera's, first against the pan about the upright axis.
      const double x = place.right * per_sample, y = -place.down * per_sample, z = 1;
      const double aside = x * std::cos(pan) - z * std::sin(pan),
                   ahead = z * std::cos(pan) + x * std::sin(pan);
      const double up = y * std::cos(pitch) - ahead * std::sin(pitch);
      const double front = ahead * std::cos(pitch) + y * std::sin(pitch);
      EXPECT_NEAR(aside / front / per_sample, right, 1e-9);
      EXPECT_NEAR(-up / front / per_sample, down, 1e-9);
      constexpr double h = 1e-4;
      const double widening = (aimed.at(right + h, down).right - aimed.at(right - h, down).right) / (2 * h);
      const double heightening = (aimed.at(right, down + h).down - aimed.at(right, down - h).down) / (2 * h);
      EXPECT_NEAR(place.widening, widening, 1e-7);
      EXPECT_NEAR(place.heightening, heightening, 1e-7);
    }
}

// The camera turns right: what was to the right of the middle comes to the middle.
TEST(SceneAim, HasTheSignsOfItsWords) {
  const Scene far = far_scene();
  EXPECT_GT((AimedPlane({.pan_deg = 5}, far).at(0, 0).right), 0);
  EXPECT_LT((AimedPlane({.pitch_deg = 5}, far).at(0, 0).down), 0);
  Scene near = far_scene();
  near.set_distance_m(2);
  const double sample_m = 2 * near.tangent_per_sample();
  const AimedPlane::Place moved =
      AimedPlane({.right_m = 3 * sample_m, .up_m = 2 * sample_m}, near).at(10, 20);
  EXPECT_NEAR(moved.right, 7, 1e-9);  // the scene went to the right: here is what was to the left
  EXPECT_NEAR(moved.down, 22, 1e-9);
}

TEST(SceneAim, RefusesMotionThatTheSceneCannotShow) {
  Scene near = far_scene();
  near.set_distance_m(2);
  EXPECT_THROW(SceneAim{.pan_deg = 1}.check(near), InputError);
  EXPECT_NO_THROW(SceneAim{.right_m = 1}.check(near));
  EXPECT_THROW(SceneAim{.right_m = 1}.check(far_scene()), InputError);
  EXPECT_NO_THROW(SceneAim{.pan_deg = 1}.check(far_scene()));
  EXPECT_THROW(SceneAim{.pan_deg = NAN}.check(far_scene()), InputError);
  EXPECT_TRUE(std::isnan(AimedPlane({.pan_deg = 120}, far_scene()).at(0, 0).right));
}

// The same in vectors, several cells at a time.
TEST(SceneAim, ARowIsTurnedAsItsCellsAre) {
  const Scene scene = far_scene();
  const AimedPlane aimed({.pan_deg = 70, .pitch_deg = 3}, scene);
  RowView straight, turned;
  for (int i = 0; i < 53; ++i) {
    straight.right.push_back(-260 + 10.0 * i);
    straight.down.push_back(40 - 3.0 * i);
    straight.width.push_back(0.7F);
    straight.height.push_back(0.4F);
    straight.g_source_sr.push_back(0.2F);
  }
  aimed.turn(straight, turned);
  int dark = 0;
  for (std::size_t i = 0; i < 53; ++i) {
    const AimedPlane::Place place = aimed.at(straight.right[i], straight.down[i]);
    if (std::isnan(place.right)) {
      EXPECT_EQ(turned.g_source_sr[i], 0);
      ++dark;
      continue;
    }
    EXPECT_EQ(turned.g_source_sr[i], 0.2F);
    EXPECT_NEAR(turned.right[i] / place.right, 1, 1e-12);
    EXPECT_NEAR(turned.down[i], place.down, 1e-9 * (1 + std::abs(place.down)));
    EXPECT_NEAR(double(turned.width[i]) / (0.7 * place.widening), 1, 1e-6);
    EXPECT_NEAR(double(turned.height[i]) / (0.4 * place.heightening), 1, 1e-6);
  }
  EXPECT_LT(dark, 50);
}

/// A texture, a lens and a frame of 64 x 48 pixels.
struct Series {
  Scene scene{400, 300, {550}, 40, {}};
  LensDataTable table = testing::make_table({});
  SensorGeometry frame{64, 48, 20};
  ImagingOptions options;

  Series() {
    std::minstd_rand random(1);
    for (float& value : scene.band(0)) value = 0.5F + static_cast<float>(random() % 1000) / 1000;
  }
};

double worst_over_peak(std::span<const float> a, std::span<const float> b) {
  double worst = 0, peak = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    worst = std::max(worst, std::abs(double(a[i]) - double(b[i])));
    peak = std::max(peak, double(b[i]));
  }
  return worst / peak;
}

// What is kept from one image to the next alters nothing.
TEST(ImageSeries, AnImageIsTheSameByItself) {
  const Series s;
  const SpectralImage alone = form_image(s.scene, s.table, s.frame, s.options);
  ImageSeries series(s.scene, s.table, s.frame, s.options);
  const AimedLight straight, aside{{{{.pan_deg = 2}}}, {}};
  series.form(std::vector{aside, straight});
  const auto again = series.form(std::vector{straight});
  EXPECT_TRUE(std::ranges::equal(again.front().band(0), alone.band(0)));
}

// Blur is linear: light that is added up before it makes the sum of the images, to the rounding of floats.
TEST(ImageSeries, LightIsAddedUpBeforeBlur) {
  const Series s;
  ImageSeries series(s.scene, s.table, s.frame, s.options);
  const AimedLight a{{{{.pan_deg = 1}}}, {}}, b{{{{.pan_deg = -1, .pitch_deg = 2}}}, {}};
  const AimedLight both{{{a.shares[0].aim, 0.25}, {b.shares[0].aim, 0.75}}, {}};
  const auto images = series.form(std::vector{a, b, both});
  std::vector<float> sum;
  for (std::size_t i = 0; i < images[0].band(0).size(); ++i)
    sum.push_back(0.25F * images[0].band(0)[i] + 0.75F * images[1].band(0)[i]);
  EXPECT_LT(worst_over_peak(images[2].band(0), sum), 1e-5);
}

TEST(ImageSeries, RowsThatAreWantedAreThoseOfTheWholeImage) {
  const Series s;
  ImageSeries series(s.scene, s.table, s.frame, s.options);
  const AimedLight whole{{{{.pan_deg = 1}}}, {}}, part{whole.shares, {10, 17}};
  const auto images = series.form(std::vector{whole, part});
  const std::size_t from = 10 * 64, count = 7 * 64;
  const auto full = images[0].band(0), some = images[1].band(0);
  EXPECT_LT(worst_over_peak(some.subspan(from, count), full.subspan(from, count)), 1e-5);
  for (std::size_t i = 0; i < some.size(); ++i)
    EXPECT_TRUE((i >= from && i < from + count) || some[i] == 0) << i;
}

}  // namespace
}  // namespace petzval
