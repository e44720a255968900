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

ImagingOptions with(Surround surround) {
  ImagingOptions options;
  options.surround = surround;
  return options;
}

TEST(CoveringAngle, IsThatOfTheFrameAndALittleBeyond) {
  const LensDataTable table = rectilinear_table();
  const SensorGeometry sensor{120, 90, 10};
  for (const auto& [columns, rows] : {std::pair{400, 300}, {300, 300}, {900, 300}})
    for (const auto& [surround, beyond] : {std::pair{Surround::error, 1.02}, {Surround::extend, 1.0}}) {
      const double angle = covering_angle_deg(bright_scene(columns, rows, 5), table, sensor, with(surround));
      // 120 × 90 pixels of 10 µm at 6 mm. The table's curve is good to 1e-4.
      const double half = beyond * std::max(0.60, 0.45 * columns / rows) / 6;
      EXPECT_NEAR(angle, 2 * degrees(std::atan(half)), 1e-4 * angle);
    }
}

TEST(CoveringAngle, LeavesNothingToSayOfAFrameThatIsCovered) {
  const LensDataTable table = rectilinear_table();
  const SensorGeometry sensor{120, 90, 10};
  for (const Surround surround : {Surround::extend, Surround::zero}) {
    const ImagingOptions options = with(surround);
    Scene scene = bright_scene(400, 300, 5);
    const double angle = covering_angle_deg(scene, table, sensor, options);
    ImagingReport report;
    scene.set_horizontal_angle_deg(angle);
    form_image(scene, table, sensor, options, {}, &report);
    EXPECT_TRUE(report.notes.empty()) << report.notes.front();
    scene.set_horizontal_angle_deg(0.999 * angle);
    form_image(scene, table, sensor, options, {}, &report);
    ASSERT_FALSE(report.notes.empty());
    EXPECT_NE(report.notes.front().find("the frame sees 11.42°"), std::string::npos) << report.notes.front();
  }
}

TEST(NaturalSensor, HasTheScenesSamplesAndAsManyAsItCovers) {
  const LensDataTable table = rectilinear_table();
  const Scene scene = bright_scene(400, 300, 20);
  const SensorGeometry sensor = natural_sensor(scene, table, {});
  EXPECT_NEAR(sensor.pitch_um, 6000 * 2 * std::tan(radians(10.0)) / 400, 1e-9);
  // Without distortion, 2 % of half the frame lies beyond it on each side: 400 / 1.02 columns.
  EXPECT_EQ(sensor.columns, 392);
  EXPECT_EQ(sensor.rows, 294);
  EXPECT_GE(natural_sensor(scene, table, with(Surround::extend)).columns, 399);
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
  EXPECT_THROW(natural_sensor(bright_scene(1, 1, 0.01), table, {}), InputError) << "less than a pixel";
  table.first_order.efl_mm = INFINITY;
  EXPECT_THROW(natural_sensor(bright_scene(400, 300, 20), table, {}), InputError) << "afocal";
}

}  // namespace
}  // namespace petzval
