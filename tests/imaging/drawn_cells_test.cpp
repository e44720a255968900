// SPDX-License-Identifier: BSD-3-Clause
// Figures of charts on the cells of a lens, against points of the figures looked up one by one.
#include "imaging/synthetic_table.h"

#include <gtest/gtest.h>
#include <petzval/imaging/distortion.h>
#include <petzval/imaging/scene_rows.h>
#include <petzval/scene/chart_canvas.h>
#include <petzval/scene/charts.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace petzval {
namespace {

using namespace testing;

/// Barrel distortion of 12 % at 20°, light that falls off.
LensDataTable barrel_table() {
  TableRecipe recipe;
  recipe.fields.clear();
  for (int field = 0; field <= 24; ++field) recipe.fields.push_back(field);
  recipe.height_mm = [](double field, double) {
    const double ideal = 6 * std::tan(radians(field));
    return ideal * (1 - 0.12 * std::pow(ideal / (6 * std::tan(radians(20.0))), 2));
  };
  recipe.g_source_sr = [](double field) { return 0.25 * std::pow(std::cos(radians(field)), 4); };
  return make_table(recipe);
}

/// Over the frame: an axis beside the middle, a bend along one side.
LensDataTable bent_table() {
  LensDataTable table;
  table.lens_name = "made by formula, over the frame";
  table.wavelengths_nm = {550};
  table.vertex_to_sensor_mm = 10;
  FramePlaces& frame = table.frame.emplace();
  for (int i = 0; i < 25; ++i) frame.x_mm.push_back(0.2 * (i - 12));
  for (int i = 0; i < 21; ++i) frame.y_mm.push_back(0.2 * (i - 10));
  for (const double y : frame.y_mm)
    for (const double x : frame.x_mm) {
      const double right = (x - 0.1 + 0.01 * y * y) / 6, up = (y + 0.05 + 0.008 * x * x) / 6;
      const double away = std::hypot(right, up), field = degrees(std::atan(away)) / away;
      frame.object_x.push_back(field * right);
      frame.object_y.push_back(field * up);
      frame.psf_azimuth_deg.push_back(0);
      table.g_source_sr.push_back(0.25 - 0.01 * x);
      table.g_sensor_sr.push_back(0.25);
      table.psf.push_back(psf_of_spots({{0, 0, 2, 2, 1}}, 65, 0.5));
    }
  table.validate();
  return table;
}

constexpr double scene_deg = 44;
const SensorGeometry grid{340, 260, 10};

ChartOptions chart(int columns, int rows, std::vector<double> wavelengths_nm) {
  ChartOptions options;
  options.columns = columns, options.rows = rows;
  options.wavelengths_nm = std::move(wavelengths_nm);
  options.horizontal_angle_deg = scene_deg;
  return options;
}

SceneMap map_of(const LensDataTable& table, const Scene& scene) {
  return {table, {}, {}, 550, scene, std::hypot(grid.width_mm(), grid.height_mm()) / 2};
}

/// RMS of cells against the mean of points in them, over the mean of all cells.
double rms_error(const Scene& scene, const LensDataTable& table,
                 const std::function<double(double column, double row)>& radiance) {
  const SceneMap map = map_of(table, scene);
  const CellPlane plane = ideal_irradiance(scene, 0, map, grid, 8, Surround::error);
  constexpr int points = 32;
  double squares = 0, sum = 0;
  int count = 0;
  for (int row = 3; row < grid.rows; row += 7)
    for (int column = 0; column < grid.columns; ++column) {
      double mean = 0;
      for (int i = 0; i < points; ++i)
        for (int j = 0; j < points; ++j) {
          const SceneMap::Place at =
              map.place(grid.x_mm(column + (j + 0.5) / points), grid.y_mm(row + (i + 0.5) / points));
          mean += at.g_source_sr * radiance(at.column, at.row) / (points * points);
        }
      const double cell = double(plane.row(static_cast<std::size_t>(row))[column]);
      squares += (cell - mean) * (cell - mean);
      sum += mean;
      ++count;
    }
  return std::sqrt(squares / count) / (sum / count);
}

/// An edge is known to half a point: 1/64 of the contrast at most in a cell that it crosses, and fewer than a
/// tenth of all cells are crossed. The samples alone, wider than cells, are off by far more.
constexpr double half_a_point = 1.0 / 64 * 0.3162;

TEST(DrawnCells, LayAnEdgeWhereItsPointsFall) {
  const ChartOptions options = chart(192, 144, {550});
  Scene edge = slanted_edge_chart(options, 5);
  ASSERT_NE(edge.drawing(), nullptr);
  const double dark = double(edge.drawing()->ground[0]),
               light = double(edge.drawing()->figures[0].radiance[0]);
  EXPECT_NEAR(light / dark, 4, 1e-6);
  const double lean = std::tan(radians(5.0));
  const auto radiance = [&](double column, double row) {
    return column - 96 > -lean * (row - 72) ? light : dark;
  };
  for (const LensDataTable& table : {barrel_table(), bent_table()}) {
    EXPECT_LT(rms_error(edge, table, radiance), half_a_point);
    Scene samples = edge;
    samples.band(0);  // to be written
    EXPECT_EQ(samples.drawing(), nullptr);
    EXPECT_GT(rms_error(samples, table, radiance), 3 * half_a_point);
  }
}

TEST(DrawnCells, LaySquaresWhereTheirPointsFall) {
  const ChartOptions options = chart(192, 144, {550});
  for (const int squares : {12, 13}) {
    const Scene board = checkerboard_chart(options, squares);
    const double white = double(board.drawing()->figures[0].radiance[0]), side = 192.0 / squares;
    const auto radiance = [&](double column, double row) {
      const int i = static_cast<int>(std::floor(column / side)),
                j = static_cast<int>(std::floor((row - 72) / side + squares / 2.0));
      return (i + j) % 2 == 0 ? white : 0.0;
    };
    for (const LensDataTable& table : {barrel_table(), bent_table()})
      EXPECT_LT(rms_error(board, table, radiance), half_a_point * 2) << squares;  // twice the mean's contrast
  }
}

/// Grey fields that share their borders on a black ground, none of which may show between them.
TEST(DrawnCells, LayFieldsThatMeetWithoutAGap) {
  ChartCanvas canvas(chart(192, 144, {550}));
  canvas.fill(canvas.flat_paint(0));
  const double side = 5.37;
  const auto level = [&](double column, double row) {
    const int i = static_cast<int>(std::floor(column / side)), j = static_cast<int>(std::floor(row / side));
    return 0.3 + 0.1 * ((i + 2 * j) % 5);
  };
  for (int j = 0; j * side < 144; ++j)
    for (int i = 0; i * side < 192; ++i) {
      Shape field;
      field.add_rectangle(i * side, j * side, (i + 1) * side, (j + 1) * side);
      canvas.draw(field, canvas.flat_paint(level((i + 0.5) * side, (j + 0.5) * side)));
    }
  const Scene scene = std::move(canvas).lit();
  const double of_white = double(scene.drawing()->figures[0].radiance[0]) / level(1, 1);
  const auto radiance = [&](double column, double row) { return of_white * level(column, row); };
  for (const LensDataTable& table : {barrel_table(), bent_table()})
    EXPECT_LT(rms_error(scene, table, radiance), half_a_point);
}

/// A ground that varies smoothly, and a turned square on it.
TEST(DrawnCells, CoverATexturedGround) {
  const auto texture = [](double column) { return 1 + 0.3 * std::sin(column / 8); };
  ChartCanvas canvas(chart(192, 144, {550}));
  canvas.modulate(canvas.flat_paint(0.4), [&](int, std::span<double> factors) {
    for (std::size_t x = 0; x < factors.size(); ++x) factors[x] = texture(double(x) + 0.5);
  });
  Shape square;
  const double turn = radians(20.0), half = 40;
  square.add_square({96, 72}, 2 * half, turn);
  canvas.draw(square, canvas.flat_paint(0.8));
  const Scene scene = std::move(canvas).lit();
  const double ground = double(scene.drawing()->ground[0]),
               light = double(scene.drawing()->figures[0].radiance[0]);
  EXPECT_NEAR(light / ground, 2, 1e-6);
  const auto radiance = [&](double column, double row) {
    const double right = column - 96, down = row - 72;
    const double along = right * std::cos(turn) + down * std::sin(turn),
                 aside = down * std::cos(turn) - right * std::sin(turn);
    return std::max(std::abs(along), std::abs(aside)) < half ? light : ground * texture(column);
  };
  for (const LensDataTable& table : {barrel_table(), bent_table()})
    EXPECT_LT(rms_error(scene, table, radiance), half_a_point);
}

TEST(DrawnCells, AreScaledWithTheSamples) {
  const ChartOptions options = chart(64, 48, {500, 550});
  const Scene once = slanted_edge_chart(options, 5);
  Scene twice = once;
  twice.scale(2);
  const std::vector<double> factors{3, 5};
  Scene by_band = once;
  by_band.scale_bands(factors);
  const LensDataTable table = bent_table();
  const auto cells = [&](const Scene& scene, int band) {
    return ideal_irradiance(scene, band, map_of(table, scene), grid, 1, Surround::error).row(100)[7];
  };
  EXPECT_NEAR(double(cells(twice, 0) / cells(once, 0)), 2, 1e-6);
  EXPECT_NEAR(double(cells(by_band, 0) / cells(once, 0)), 3, 1e-6);
  EXPECT_NEAR(double(cells(by_band, 1) / cells(once, 1)), 5, 1e-6);
}

TEST(SceneLook, FindsThePlaceOfTheImageThatSeesASample) {
  const Scene scene(192, 144, {550}, scene_deg, std::nullopt);
  for (const LensDataTable& table : {barrel_table(), bent_table()}) {
    const SceneMap map = map_of(table, scene);
    ImagePlace near;
    for (double x = -2.4; x < 2.41; x += 0.31)  // the frame ends at 1.7 and 1.3
      for (double y = -1.7; y < 1.71; y += 0.23) {
        const SceneMap::Place seen = map.place(x, y);
        if (std::hypot(x, y) > map.last_height_mm()) continue;
        const std::optional<ImagePlace> place = map.look().image_of(seen.column, seen.row, near);
        ASSERT_TRUE(place);
        near = *place;
        EXPECT_NEAR(place->x_mm, x, 1e-7);
        EXPECT_NEAR(place->y_mm, y, 1e-7);
      }
  }
}

}  // namespace
}  // namespace petzval
