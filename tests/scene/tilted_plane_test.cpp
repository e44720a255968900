// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/scene/scene_file.h>
#include <petzval/scene/tilted_plane.h>

#include <cmath>

namespace petzval {
namespace {

/// A scene whose radiance is the place: across in the first band, down in the second, from 0 to 1.
Scene ruler(double angle_deg, double distance_m) {
  Scene scene(80, 60, {500, 600}, angle_deg, distance_m);
  for (int row = 0; row < 60; ++row)
    for (int column = 0; column < 80; ++column) {
      const auto at = static_cast<std::size_t>(row * 80 + column);
      scene.band(0)[at] = static_cast<float>((column + 0.5) / 80);
      scene.band(1)[at] = static_cast<float>((row + 0.5) / 60);
    }
  return scene;
}

TEST(TiltedPlane, IsWhereLinesOfSightMeetIt) {
  constexpr double distance = 2, angle = 40;
  for (const double tilt : {30.0, -55.0}) {
    const Scene scene = tilted(ruler(angle, distance), tilt);
    const double half = std::tan(radians(angle / 2)), s = std::sin(radians(tilt)),
                 c = std::cos(radians(tilt));
    // The line of sight z (x, y, 1) meets the plane of (u c, v, distance + u s): its places u, v.
    const auto meet = [&](double x, double y) {
      const double u = x * distance / (c - x * s), z = distance + u * s;
      return std::array<double, 3>{u, y * z, z};
    };
    // The far edge of the frame sees the far edge of the scene, which is so wide and has square samples.
    const double wide = std::abs(meet(tilt > 0 ? half : -half, 0)[0]);
    for (const int row : {3, 30, 55})
      for (const int column : {5, 40, 70}) {
        const double x = half * ((column + 0.5) / 40 - 1), y = half * ((row + 0.5) / 40 - 0.75);
        const auto [u, v, z] = meet(x, y);
        const auto at = static_cast<std::size_t>(row * 80 + column);
        EXPECT_NEAR(scene.depth_m[at], z, 1e-5 * z);
        // Means over a sample of what is not straight: to a hundredth of a sample.
        const double across = (u / wide + 1) / 2, down = 0.5 + v / wide / 2 * 80 / 60;
        if (across > 0.02 && across < 0.98) {
          EXPECT_NEAR(scene.band(0)[at], across, 2e-4) << tilt;
        }
        if (down > 0.02 && down < 0.98) {
          EXPECT_NEAR(scene.band(1)[at], down, 2e-4) << tilt;
        }
      }
  }
}

TEST(TiltedPlane, NotTiltedIsTheScene) {
  const Scene before = ruler(30, 1), after = tilted(before, 0);
  for (int row = 1; row < 59; ++row)
    for (int column = 1; column < 79; ++column)
      EXPECT_NEAR(after.band(0)[static_cast<std::size_t>(row * 80 + column)], (column + 0.5) / 80, 1e-6);
}

TEST(TiltedPlane, RefusesWhatCannotBeTilted) {
  EXPECT_THROW(tilted(ruler(40, 1), 80), InputError);
  EXPECT_THROW(tilted(ruler(150, 1), 60), InputError) << "the plane vanishes within the view";
  EXPECT_THROW(tilted(Scene(8, 6, {550}, 40, std::nullopt), 30), InputError);
  EXPECT_THROW(read_scene("cards", {.tilt_deg = 30.0}), InputError);
  EXPECT_THROW(read_scene("wall", {.distance_m = INFINITY, .tilt_deg = 30.0}), InputError);
}

TEST(SceneWidth, IsTheWidthAtTheDistance) {
  const Scene scene = read_scene("wall", {.columns = 8, .rows = 6, .width_m = 0.2, .distance_m = 0.4});
  EXPECT_NEAR(2 * 0.4 * std::tan(radians(scene.horizontal_angle_deg() / 2)), 0.2, 1e-12);
  EXPECT_THROW(read_scene("wall", {.width_m = 0.2}), InputError);
  EXPECT_THROW(read_scene("wall", {.horizontal_angle_deg = 30.0, .width_m = 0.2, .distance_m = 0.4}),
               InputError);
}

}  // namespace
}  // namespace petzval
