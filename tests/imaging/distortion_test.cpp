// SPDX-License-Identifier: BSD-3-Clause
#include "imaging/synthetic_table.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>
#include <petzval/imaging/distortion.h>
#include <petzval/imaging/scene_rows.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>

namespace petzval {
namespace {

using namespace testing;

/// Barrel distortion of 12 % at 20°, in closed form.
double barrel_height_mm(double field_deg) {
  const double ideal = 6 * std::tan(radians(field_deg));
  return ideal * (1 - 0.12 * std::pow(ideal / (6 * std::tan(radians(20.0))), 2));
}

TableRecipe barrel_recipe() {
  TableRecipe recipe;
  recipe.fields.clear();
  for (int field = 0; field <= 24; ++field) recipe.fields.push_back(field);
  recipe.height_mm = [](double field, double) { return barrel_height_mm(field); };
  return recipe;
}

SceneMap map_of(const LensDataTable& table, const Scene& scene, const SensorGeometry& grid,
                std::optional<double> distance_mm = {}) {
  return {RadialProfiles(table).at_wavelength(550), distance_mm, scene,
          std::hypot(grid.width_mm(), grid.height_mm()) / 2};
}

// A star at a known object angle lands where the lens puts that angle: at eight azimuths, upright. The star
// is a Gaussian of 1.5 pixels, which pixels resolve, on a scene three times finer, so that straight lines
// between samples leave no moiré; the curvature of the distortion moves its centre of gravity by less than
// 0.01 pixel.
TEST(IdealIrradiance, PutsPointsWhereTheTableSays) {
  const LensDataTable table = make_table(barrel_recipe());
  const SensorGeometry grid{401, 301, 10};
  for (int eighth = 0; eighth < 8; ++eighth) {
    const double azimuth = radians(45.0 * eighth + 10);
    const int column = static_cast<int>(std::lround(750 + 420 * std::cos(azimuth)));
    const int row = static_cast<int>(std::lround(570 + 420 * std::sin(azimuth)));
    Scene scene(1501, 1141, {550}, 45, std::nullopt);
    add_star(scene, 0, column, row, 4.5);
    const double right = (column - 750) * scene.tangent_per_sample();
    const double down = (row - 570) * scene.tangent_per_sample();
    const double tangent = std::hypot(right, down);
    const double height_pixels = barrel_height_mm(degrees(std::atan(tangent))) / 0.010;
    const CellPlane image = ideal_irradiance(scene, 0, map_of(table, scene, grid), grid, 4, Surround::error);
    const Centroid centre = centroid(image);
    EXPECT_NEAR(centre.column, 200.5 + height_pixels * right / tangent, 0.02) << eighth;
    EXPECT_NEAR(centre.row, 150.5 + height_pixels * down / tangent, 0.02) << eighth;
  }
}

TEST(SceneMap, FollowsTheTableWithinAThousandthOfASample) {
  const LensDataTable table = make_table(barrel_recipe());
  const Scene scene(501, 381, {550}, 45, std::nullopt);
  const SensorGeometry grid{401, 301, 10};
  const SceneMap map = map_of(table, scene, grid);
  for (double field = 0.01; field < 22; field += 0.173) {
    const double height = RadialProfiles(table).at_wavelength(550).image_height_mm(field);
    const SceneMap::Place place = map.place(-height * 0.6, height * 0.8);
    const double radius = std::tan(radians(field)) / scene.tangent_per_sample();
    EXPECT_NEAR(place.column, 250.5 + 0.6 * radius, 1e-3) << field;
    EXPECT_NEAR(place.row, 190.5 + 0.8 * radius, 1e-3) << field;
  }
}

TEST(SceneMap, TakesFiniteObjectsByTheirHeight) {
  // Object heights in mm at 250 mm from the sensor, magnification −1/40: a pixel of 5 µm sees 0.2 mm.
  TableRecipe recipe;
  recipe.fields = {0, 20, 40, 60};
  recipe.object_distance_mm = 240;
  recipe.height_mm = [](double field, double) { return field / 40; };
  const LensDataTable table = make_table(recipe);
  Scene scene(200, 100, {550}, degrees(2 * std::atan(0.2)), 0.25);  // 100 mm wide: samples of 0.5 mm
  const SceneMap map = map_of(table, scene, {100, 100, 5}, 250.0);
  const SceneMap::Place place = map.place(-0.1, 0.05);  // images of 4 mm to the right and 2 mm down
  EXPECT_NEAR(place.column, 108, 1e-9);
  EXPECT_NEAR(place.row, 54, 1e-9);
  EXPECT_NEAR(map.finest_samples_per_mm(), 80, 1e-9);
}

TEST(SceneMap, IsDarkBeyondTheLastField) {
  const LensDataTable table = make_table({});
  const double last_mm = table.real_image_height_mm.back();
  const Scene scene(100, 100, {550}, 60, std::nullopt);
  const SceneMap map(RadialProfiles(table).at_wavelength(550), {}, scene, 10);
  EXPECT_EQ(map.last_height_mm(), last_mm);
  EXPECT_EQ(map.place(0, last_mm).g_source_sr, 0.25);
  EXPECT_EQ(map.place(0, last_mm * 1.001).g_source_sr, 0);
}

TEST(SeenExtent, IsWhereTheOutlineLooks) {
  const LensDataTable table = make_table({});  // height 6 tan: no distortion
  const Scene scene(1000, 1000, {550}, 60, std::nullopt);
  const double samples_per_mm = 1 / (6 * scene.tangent_per_sample());
  const SensorGeometry grid{300, 200, 10};
  const SeenExtent seen = seen_extent(map_of(table, scene, grid), grid);
  // The table's curve between fields 5° apart misses the tangent by some 1e-5.
  EXPECT_NEAR(seen.columns / (1.5 * samples_per_mm), 1, 1e-4);
  EXPECT_NEAR(seen.rows / (1.0 * samples_per_mm), 1, 1e-4);
  EXPECT_NEAR(seen.radius / (std::hypot(1.5, 1.0) * samples_per_mm), 1, 1e-4);
  // Where the corners are dark, up to the last field only.
  const SensorGeometry wide{500, 400, 10};
  const double last = table.real_image_height_mm.back();
  EXPECT_NEAR(seen_extent(map_of(table, scene, wide), wide).columns / (last * samples_per_mm), 1, 1e-4);
}

TEST(IdealIrradiance, AveragesScenesThatAreFinerThanCells) {
  // Stripes one sample wide, some five to a pixel: their mean must come out, not their aliases.
  Scene scene(2000, 1500, {550}, 40, std::nullopt);
  for (std::size_t i = 0; i < scene.band_size(); ++i) scene.band(0)[i] = i % 2 == 0 ? 2.0F : 0.0F;
  const LensDataTable table = make_table({});
  const SensorGeometry grid{300, 200, 10};
  const SceneMap map = map_of(table, scene, grid);
  const double samples_per_cell = map.finest_samples_per_mm() * 0.010;
  ASSERT_GT(samples_per_cell, 4);
  const CellPlane image =
      ideal_irradiance(scene, 0, map, grid, static_cast<int>(std::ceil(samples_per_cell)), Surround::error);
  // At least one bilinear point a sample over a width that is no whole number of stripes: a part of one
  // stripe is left over, of some nine points.
  for (const float value : image.values) EXPECT_NEAR(value, 0.25, 0.25 / samples_per_cell);
  EXPECT_NEAR(sum_of(image) / double(image.values.size()), 0.25, 0.25 * 2e-3);
}

/// The mean of the straight lines between samples along an axis: by the antiderivative of a sample's share.
double share_of_sample(double sample, double middle, double length) {
  const auto below = [&](double x) {  // the part of a triangle's light before x
    const double t = std::clamp(x - (sample + 0.5), -1.0, 1.0);
    return t < 0 ? (1 + t) * (1 + t) / 2 : 1 - (1 - t) * (1 - t) / 2;
  };
  return (below(middle + length / 2) - below(middle - length / 2)) / length;
}

/// Of a stretch about a place, how much lies between 0 and an end.
double share_within(double middle, double length, double end) {
  return std::max(0.0, std::min(middle + length / 2, end) - std::max(middle - length / 2, 0.0)) / length;
}

/// Mean radiance × g_source of a cell, from what the map says of its middle and the middles of its sides. The
/// scene goes on beyond its edges, unless it is dark there.
double mean_of_cell(const Scene& scene, const SceneMap& map, const SensorGeometry& grid, int column, int row,
                    Surround surround = Surround::extend) {
  const SceneMap::Place middle = map.place(grid.x_mm(column + 0.5), grid.y_mm(row + 0.5));
  if (middle.g_source_sr == 0) return 0;
  const double width = map.place(grid.x_mm(column + 1), grid.y_mm(row + 0.5)).column -
                       map.place(grid.x_mm(column), grid.y_mm(row + 0.5)).column;
  const double height = map.place(grid.x_mm(column + 0.5), grid.y_mm(row + 1)).row -
                        map.place(grid.x_mm(column + 0.5), grid.y_mm(row)).row;
  double sum = 0;
  for (int i = static_cast<int>(middle.row) - 4; i <= static_cast<int>(middle.row) + 4; ++i)
    for (int j = static_cast<int>(middle.column) - 4; j <= static_cast<int>(middle.column) + 4; ++j) {
      const int sample_row = std::clamp(i, 0, scene.rows() - 1),
                sample = std::clamp(j, 0, scene.columns() - 1);
      sum += share_of_sample(i, middle.row, height) * share_of_sample(j, middle.column, width) *
             double(scene.band(0)[static_cast<std::size_t>(sample_row * scene.columns() + sample)]);
    }
  if (surround == Surround::zero)
    sum *= share_within(middle.row, std::abs(height), scene.rows()) *
           share_within(middle.column, std::abs(width), scene.columns());
  return middle.g_source_sr * sum;
}

TEST(IdealIrradiance, DrawsStraightLinesBetweenSamplesWhereTheImageGrows) {
  // A sample covers a dozen cells: each has the mean of what it sees.
  Scene scene(40, 30, {550}, 40, std::nullopt);
  for (std::size_t i = 0; i < scene.band_size(); ++i) scene.band(0)[i] = static_cast<float>(i * i % 17);
  const SensorGeometry grid{300, 200, 10};
  const SceneMap map = map_of(make_table({}), scene, grid);
  ASSERT_LT(map.finest_samples_per_mm() * 0.010, 0.1);
  const CellPlane image = ideal_irradiance(scene, 0, map, grid, 1, Surround::error);
  for (int row = 0; row < grid.rows; row += 7)
    for (int column = 0; column < grid.columns; column += 11)
      EXPECT_NEAR(image.values[static_cast<std::size_t>(row * grid.columns + column)],
                  mean_of_cell(scene, map, grid, column, row), 1e-5);
}

TEST(IdealIrradiance, ShowsTheSurroundThatIsAskedFor) {
  Scene scene(20, 20, {550}, 10, std::nullopt);
  std::fill(scene.band(0).begin(), scene.band(0).end(), 4.0F);
  const LensDataTable table = make_table({});
  const SensorGeometry grid{300, 200, 10};  // sees 28°
  const SceneMap map = map_of(table, scene, grid);
  const CellPlane zero = ideal_irradiance(scene, 0, map, grid, 1, Surround::zero);
  const CellPlane extended = ideal_irradiance(scene, 0, map, grid, 1, Surround::extend);
  EXPECT_EQ(zero.row(100)[0], 0);
  EXPECT_FLOAT_EQ(zero.row(100)[150], 1);
  for (const float value : extended.values) EXPECT_FLOAT_EQ(value, 1);
}

// Every cell has the light of its own place, whether it is done with others or alone: on grids of odd and
// even sizes, up to the edge of the scene and into the dark corners, of a scene that is nowhere symmetric.
TEST(IdealIrradiance, IsThatOfEachCellsOwnPlace) {
  Scene scene(401, 299, {550}, 60, std::nullopt);
  for (std::size_t i = 0; i < scene.band_size(); ++i)
    scene.band(0)[i] = 1 + static_cast<float>((i * 2654435761U >> 7) % 1000) / 1000;
  const LensDataTable table = make_table(barrel_recipe());
  for (const auto& [columns, rows] : {std::pair{600, 400}, {601, 401}, {33, 20}, {17, 9}, {15, 1}, {7, 5}}) {
    const SensorGeometry grid{columns, rows, 7.5};
    const SceneMap map = map_of(table, scene, grid);
    ASSERT_LE(map.finest_samples_per_mm() * 0.0075, 1);
    const CellPlane image = ideal_irradiance(scene, 0, map, grid, 1, Surround::extend);
    std::size_t dark = 0;
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        const double wanted = mean_of_cell(scene, map, grid, column, row);
        const double height_mm = std::hypot(grid.x_mm(column + 0.5), grid.y_mm(row + 0.5));
        if (std::abs(height_mm - map.last_height_mm()) < 0.0075) continue;  // half dark
        if (wanted == 0) ++dark;
        // The map's slope along a cell changes by as much.
        ASSERT_NEAR(image.row(static_cast<std::size_t>(row))[column], wanted, 3e-5) << row << ", " << column;
      }
    EXPECT_EQ(dark > 0, columns >= 600) << columns;
  }
}

// The scene ends within the frame: cells that see some of it have as much, and none beyond have any, or all
// go on with its last samples.
TEST(IdealIrradiance, EndsWhereTheSceneEnds) {
  Scene scene(211, 157, {550}, 25, std::nullopt);
  for (std::size_t i = 0; i < scene.band_size(); ++i)
    scene.band(0)[i] = 1 + static_cast<float>((i * 2654435761U >> 7) % 1000) / 1000;
  const SensorGeometry grid{431, 301, 7.5};
  const SceneMap map = map_of(make_table(barrel_recipe()), scene, grid);
  ASSERT_LE(map.finest_samples_per_mm() * 0.0075, 1);
  for (const Surround surround : {Surround::zero, Surround::extend}) {
    const CellPlane image = ideal_irradiance(scene, 0, map, grid, 1, surround);
    std::size_t beyond = 0;
    for (int row = 0; row < grid.rows; ++row)
      for (int column = 0; column < grid.columns; ++column) {
        const double wanted = mean_of_cell(scene, map, grid, column, row, surround);
        if (wanted == 0) ++beyond;
        // As above; where the scene ends, the whole of a sample's light stands beside what is left out.
        ASSERT_NEAR(image.row(static_cast<std::size_t>(row))[column], wanted, 1e-4) << row << ", " << column;
      }
    EXPECT_EQ(beyond > 1000, surround == Surround::zero);
  }
}

// From two doubles at a time to eight, whichever this machine can: inside the scene, at its edge and beyond,
// where samples lie together and (on the small scene) where they do not.
TEST(IdealIrradiance, IsTheSameOnEveryInstructionSet) {
  for (const auto& [columns, rows, angle_deg] :
       {std::tuple{211, 157, 25.0}, {401, 299, 40.0}, {13, 9, 20.0}}) {
    Scene scene(columns, rows, {550}, angle_deg, std::nullopt);
    for (std::size_t i = 0; i < scene.band_size(); ++i)
      scene.band(0)[i] = 1 + static_cast<float>((i * 2654435761U >> 7) % 1000) / 1000;
    const SensorGeometry grid{331, 201, 7.5};
    const SceneMap map = map_of(make_table(barrel_recipe()), scene, grid);
    for (const Surround surround : {Surround::zero, Surround::extend}) {
      const CellPlane expected = ideal_irradiance(scene, 0, map, grid, 1, surround);
      for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        hwy::SetSupportedTargetsForTest(target);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        const CellPlane image = ideal_irradiance(scene, 0, map, grid, 1, surround);
        for (std::size_t i = 0; i < image.values.size(); ++i)
          // The rounding of some twenty operations on floats of up to 2.
          ASSERT_NEAR(image.values[i], expected.values[i], 1e-5) << hwy::TargetName(target) << " " << i;
      }
      hwy::SetSupportedTargetsForTest(0);
      hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    }
  }
}

}  // namespace
}  // namespace petzval
