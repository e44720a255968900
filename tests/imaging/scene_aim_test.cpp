// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/imaging/scene_aim.h>

#include <cmath>

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

}  // namespace
}  // namespace petzval
