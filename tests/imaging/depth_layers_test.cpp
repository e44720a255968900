// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/camera/mounted_lens.h>
#include <petzval/imaging/depth_layers.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_file.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

namespace petzval {
namespace {

Lens focused(const char* name, std::optional<double> distance_m) {
  MountedLens camera(read_lens(name).lens);
  camera.focus_at_m(distance_m);
  return camera.lens();
}

/// Depths that run linearly in dioptres, one a column.
Scene ramp(double from_m, double to_m, int columns = 400) {
  Scene scene(columns, 1, {550}, 30, 1.0);
  for (int i = 0; i < columns; ++i) {
    const double t = i / (columns - 1.0);
    scene.depth_m.push_back(static_cast<float>(1 / ((1 - t) / from_m + t / to_m)));
  }
  return scene;
}

std::string refusal(const std::function<void()>& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing was refused";
}

// By similar triangles behind the lens: the exit pupil, the image of the object, the sensor between them.
TEST(DefocusLaw, IsTheShadowOfTheExitPupil) {
  for (const char* name : {"dgauss-50mm", "wide-22mm", "petzval-lens"})
    for (const double focus_m : {0.8, 3.0}) {
      const Lens lens = focused(name, focus_m);
      const DefocusLaw law(lens);
      for (const double object_m : {0.6, 1.0, 2.0, 20.0}) {
        MountedLens at(lens);
        at.place_object_at_m(object_m);
        const FirstOrder first = first_order(at.lens());
        const double to_sensor_mm = lens.surfaces.back().thickness_mm;
        // Both from the sensor; the exit pupil lies at a negative distance.
        const double image_mm = first.paraxial_image_mm - to_sensor_mm;
        const double expected_um =
            1e3 * first.exit_pupil.diameter_mm * image_mm / (image_mm - first.exit_pupil.position_mm);
        EXPECT_NEAR(law.blur_um(law.vergence(object_m)), expected_um, 1e-6 * std::abs(expected_um) + 1e-6)
            << name << ' ' << focus_m << ' ' << object_m;  // rounding of pupils far away
        EXPECT_NEAR(*law.distance_m(law.vergence(object_m)), object_m, 1e-12 * object_m);
      }
      EXPECT_FALSE(law.distance_m(law.vergence({})));
    }
}

TEST(DepthLayers, LieInStepsOfAPixelOfBlurAboutTheFocus) {
  const Lens lens = focused("dgauss-50mm", 1.0);
  const DefocusLaw law(lens);
  const Scene scene = ramp(0.8, 1.3);
  constexpr double pixel_um = 50;
  const DepthLayers layers = lay_depth_layers(scene, lens, law, pixel_um, {});
  EXPECT_NEAR(*layers.layers.front().distance_m, 1.3, 1e-6);
  EXPECT_NEAR(*layers.layers.back().distance_m, 0.8, 1e-6);
  double nearest_to_focus = INFINITY, shares = layers.layers[0].share;
  for (std::size_t i = 1; i < layers.layers.size(); ++i) {
    const double step = layers.layers[i].blur_um - layers.layers[i - 1].blur_um;
    EXPECT_GT(step, 0);
    // A pixel, or an eighth of more than eight; the last step may be an eighth larger.
    EXPECT_LE(step, pixel_um * std::max(1.0, std::abs(layers.layers[i].blur_um) / pixel_um / 7));
    nearest_to_focus = std::min(nearest_to_focus, std::abs(layers.layers[i].blur_um));
    shares += layers.layers[i].share;
  }
  EXPECT_LT(nearest_to_focus, 1e-9);
  EXPECT_NEAR(shares, 1, 1e-9);
  // Whoever lies between two layers has the blur between theirs.
  for (std::size_t i = 0; i < layers.place.size(); ++i) {
    double blur = 0, all = 0;
    for (std::size_t k = 0; k < layers.layers.size(); ++k) {
      blur += layers.share(i, k) * layers.layers[k].blur_um;
      all += layers.share(i, k);
    }
    EXPECT_NEAR(all, 1, 1e-6);
    EXPECT_NEAR(blur, law.blur_um(law.vergence(double(scene.depth_m[i]))), 1e-3);  // float places
  }
}

TEST(DepthLayers, AreTheDepthsThemselvesWhereThereAreFew) {
  const Lens lens = focused("dgauss-50mm", 1.0);
  Scene scene(4, 1, {550}, 30, 1.0);
  scene.depth_m = {2, 0, 0.75, 2};  // nothing is there: infinity
  const DepthLayers layers = lay_depth_layers(scene, lens, DefocusLaw(lens), 10, {});
  ASSERT_EQ(layers.layers.size(), 3u);
  EXPECT_FALSE(layers.layers[0].distance_m);
  EXPECT_EQ(*layers.layers[1].distance_m, 2);
  EXPECT_EQ(*layers.layers[2].distance_m, 0.75);
  EXPECT_EQ(layers.place, (std::vector<float>{1, 0, 2, 1}));
}

TEST(DepthLayers, AreAsManyAsWasAskedFor) {
  const Lens lens = focused("dgauss-50mm", 1.0);
  for (const int count : {1, 2, 3, 7, 100})
    EXPECT_EQ(lay_depth_layers(ramp(0.7, 4), lens, DefocusLaw(lens), 10, {count}).layers.size(),
              static_cast<std::size_t>(count));
  EXPECT_LE(lay_depth_layers(ramp(0.2, 1e9), lens, DefocusLaw(lens), 1, {}).layers.size(), 64u);
  EXPECT_NE(
      refusal([&] { lay_depth_layers(ramp(0.7, 4), lens, DefocusLaw(lens), 10, {-1}); }).find("1 to 1000"),
      std::string::npos);
}

// Between a thing at 0.7 m and a wall at 3 m lie one or two samples of depths where nothing is. They belong
// to either; a slope as steep, of more samples, is a slope.
TEST(DepthLayers, HaveNoBeadsWhereASilhouetteRunsThroughSamples) {
  const Lens lens = focused("dgauss-50mm", 3.0);
  const DefocusLaw law(lens);
  for (const std::vector<float>& between :
       {std::vector<float>{1.2F}, {0.9F, 2.0F}, {0.75F, 0.82F, 0.9F, 1.0F, 1.2F, 1.5F, 1.9F, 2.4F}}) {
    for (const bool upright : {false, true}) {
      std::vector<float> line;
      for (int i = 0; i < 20; ++i) line.push_back(0.7F + 1e-4F * static_cast<float>(i));
      line.insert(line.end(), between.begin(), between.end());
      for (int i = 0; i < 20; ++i) line.push_back(3 + 1e-3F * static_cast<float>(i));
      const auto length = static_cast<int>(line.size());
      Scene scene(upright ? 1 : length, upright ? length : 1, {550}, 1, 1.0);
      scene.depth_m = line;
      const DepthLayers layers = lay_depth_layers(scene, lens, law, 40, {});
      const double near = double(layers.place[19]), far = double(layers.place[line.size() - 20]);
      ASSERT_GT(std::abs(near - far), 4);
      for (std::size_t i = 0; i < between.size(); ++i) {
        const double place = double(layers.place[20 + i]), off = std::abs(place - near);
        if (between.size() <= 2) {
          EXPECT_LT(off, 0.1) << between.size() << ' ' << i;
        } else if (i == 3 || i == 4) {
          EXPECT_GT(off, 1) << i;
        }
      }
    }
  }
}

TEST(DepthLayers, RefuseDepthsWithinTheLens) {
  const Lens lens = focused("dgauss-50mm", 1.0);
  Scene scene = ramp(0.7, 4);
  scene.depth_m[7] = 0.05F;
  EXPECT_NE(refusal([&] { lay_depth_layers(scene, lens, DefocusLaw(lens), 10, {}); }).find("row 0, column 7"),
            std::string::npos);
}

// A line of sight of range r under an angle θ ends r cos θ in front of the pupil.
TEST(DepthLayers, CountFromWhereTheMapDoes) {
  Scene scene(3, 1, {550}, 2 * degrees(std::atan(0.75)), std::nullopt);  // tangents −0.5, 0, 0.5
  scene.depth_m = {2, 2, 0};
  scene.depth_from = DepthFrom::pupil;
  EXPECT_NEAR(axial_depths_m(scene, 80)[0], 2.08, 1e-12);
  scene.depth_from = DepthFrom::range;
  EXPECT_NEAR(axial_depths_m(scene, 80)[0], 0.08 + 2 / std::sqrt(1.25), 1e-12);
  EXPECT_NEAR(axial_depths_m(scene, 80)[1], 2.08, 1e-12);
  EXPECT_TRUE(std::isinf(axial_depths_m(scene, 80)[2]));
}

}  // namespace
}  // namespace petzval
