// SPDX-License-Identifier: BSD-3-Clause
#include "imaging/synthetic_table.h"

#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/imaging/field_of_view.h>

#include <cmath>

namespace petzval {
namespace {

using namespace testing;

LensDataTable rectilinear_table() {
  LensDataTable table = make_table({});  // height 6 tan(field)
  table.first_order.efl_mm = 6;
  return table;
}

Scene bright_scene(int columns, int rows, double angle_deg) {
  Scene scene(columns, rows, {550}, angle_deg, std::nullopt);
  std::fill(scene.band(0).begin(), scene.band(0).end(), 1.0F);
  return scene;
}

/// With which the margin is widest.
ImagingOptions one_cell() {
  ImagingOptions options;
  options.supersample = 1;
  return options;
}

TEST(CoveringAngle, JustCoversTheFrameAndItsMargin) {
  const LensDataTable table = rectilinear_table();
  const SensorGeometry sensor{120, 90, 10};
  for (const auto& [columns, rows] : {std::pair{400, 300}, {300, 300}, {900, 300}}) {
    Scene scene = bright_scene(columns, rows, 5);
    const double angle = covering_angle_deg(scene, table, sensor, one_cell());
    // The PSF reaches 3 cells, its window 3, the pixel filter 2, the source filter 1: 138 × 108 cells of 10
    // µm at 6 mm. The table's curve is good to 1e-4.
    const double half = std::max(0.69, 0.54 * columns / rows) / 6;
    EXPECT_NEAR(angle, 2 * degrees(std::atan(half)), 1e-4 * angle);
    scene.set_horizontal_angle_deg(angle);
    EXPECT_NO_THROW(form_image(scene, table, sensor, one_cell()));
    EXPECT_NO_THROW(form_image(scene, table, sensor, {}));
    scene.set_horizontal_angle_deg(angle * 0.999);
    EXPECT_THROW(form_image(scene, table, sensor, one_cell()), InputError);
  }
}

TEST(NaturalSensor, HasTheScenesSamplesAndAsManyAsItCovers) {
  const LensDataTable table = rectilinear_table();
  const Scene scene = bright_scene(400, 300, 20);
  const SensorGeometry sensor = natural_sensor(scene, table, {});
  EXPECT_NEAR(sensor.pitch_um, 6000 * 2 * std::tan(radians(10.0)) / 400, 1e-9);
  // Without distortion the frame loses the margin of the PSF on each side, ⌈(22.6 + 0.25) µm / 5.29 µm⌉ = 5,
  // and those of its window, the pixel filter and the source filter, 3, 2 and 1. Of 300 rows 278 are left,
  // and of columns as many as that shape has.
  EXPECT_NEAR(sensor.rows, 278, 1);
  EXPECT_NEAR(sensor.columns, 4.0 / 3 * sensor.rows, 1);
  EXPECT_NO_THROW(form_image(scene, table, sensor, {}));
  ImagingOptions unblurred;
  unblurred.method = BlurMethod::none;
  EXPECT_GE(natural_sensor(scene, table, unblurred).columns, 399);
}

TEST(NaturalSensor, FollowsTheMagnificationOfFiniteObjects) {
  TableRecipe recipe;
  recipe.fields = {0, 20, 40, 60, 80};
  recipe.object_distance_mm = 240;
  recipe.height_mm = [](double field, double) { return field / 40; };
  LensDataTable table = make_table(recipe);
  table.first_order.magnification = -1.0 / 40;
  Scene scene(200, 100, {550}, degrees(2 * std::atan(0.2)), 0.25);  // samples of 0.5 mm
  EXPECT_NEAR(natural_pitch_um(scene, table.first_order), 12.5, 1e-9);
}

TEST(NaturalSensor, RefusesLensesAndScenesThatGiveNone) {
  LensDataTable table = rectilinear_table();
  EXPECT_THROW(natural_sensor(bright_scene(4, 4, 0.01), table, {}), InputError) << "smaller than the PSF";
  table.first_order.efl_mm = INFINITY;
  EXPECT_THROW(natural_sensor(bright_scene(400, 300, 20), table, {}), InputError) << "afocal";
}

}  // namespace
}  // namespace petzval
