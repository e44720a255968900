// SPDX-License-Identifier: BSD-3-Clause
// Truth of three-dimensional scenes against geometry in closed form, of a camera that moves too.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/lens_file.h>
#include <petzval/simulate/scene_truth.h>
#include <scratch.h>

#include <algorithm>
#include <cmath>

namespace petzval {
namespace {

constexpr int columns = 32, rows = 24;
constexpr double wall_z = 2;
/// Pixels for a tangent of 1: 30 degrees across the shorter side.
const double focal_px = rows / 2.0 / std::tan(radians(15));

/// Before a wall 2 units away, x to the right. \param wall  statements before its shape.
std::string scene_text(const std::string& wall, const std::string& shape = "-9 -9 2  9 -9 2  -9 9 2  9 9 2") {
  return "LookAt 0 0 0  0 0 1  0 1 0\nCamera \"perspective\" \"float fov\" 30\nFilm \"rgb\" \"integer "
         "xresolution\" 32 "
         "\"integer yresolution\" 24 \"float diagonal\" 20\nWorldBegin\n" +
         wall + "Shape \"bilinearmesh\" \"point3 P\" [ " + shape + " ]\n";
}

struct Wall {
  test::Scratch scratch;
  RenderRequest request;

  explicit Wall(const std::string& text = scene_text("LightSource \"infinite\"\n")) {
    request.scene = scratch.with("wall.pbrt", text);
    request.focus_as_in_scene = true;
    request.wavelengths_nm = {550};
  }
  void give_lens() {
    request.focus_as_in_scene = false;
    request.camera.lens = read_lens("dgauss-50mm").lens;
    request.camera.focus = Focus::at_m(wall_z);
  }
  std::vector<float> flow() const { return flow_seen(prepare_scene(request)); }
};

/// Calls check(x, y, right, down): tangents of a pixel's middle and its flow.
template <typename Check>
void for_each_flow(const std::vector<float>& flow, const Check& check) {
  ASSERT_EQ(flow.size(), 2u * columns * rows);
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const std::size_t at = 2 * static_cast<std::size_t>(row * columns + column);
      check((column + 0.5 - columns / 2.0) / focal_px, (row + 0.5 - rows / 2.0) / focal_px,
            static_cast<double>(flow[at]), static_cast<double>(flow[at + 1]));
    }
}

/// Embree's single precision is 1e-6 of the wall's size of 18 units: 4e-4 pixels.
constexpr double flow_error_px = 1e-3;

TEST(SceneFlow, OfACameraThatMovesSidewaysIsTheSameEverywhere) {
  Wall wall;
  wall.request.camera_move = wall.request.look_move = {0.1, 0, 0};
  for (const double rolling : {0.0, 0.5}) {
    wall.request.rolling_shutter = rolling;
    for_each_flow(wall.flow(), [&](double, double, double right, double down) {
      EXPECT_NEAR(right, -focal_px * 0.1 * (1 - rolling) / wall_z, flow_error_px);
      EXPECT_NEAR(down, 0, flow_error_px);
    });
  }
}

TEST(SceneFlow, OfRowsThatFollowWhatMovesDownIsThatOfALaterRow) {
  Wall wall;
  wall.request.camera_move = wall.request.look_move = {0, 0.2, 0};
  const double rolling = wall.request.rolling_shutter = 0.6, all_px = focal_px * 0.2 / wall_z;
  for_each_flow(wall.flow(), [&](double, double, double right, double down) {
    EXPECT_NEAR(right, 0, flow_error_px);
    EXPECT_NEAR(down, all_px * (1 - rolling) / (1 - all_px * rolling / (rows - 1)), flow_error_px);
  });
}

TEST(SceneFlow, OfACameraThatTurnsIsAHomography) {
  Wall wall;
  wall.request.look_at = {0, 0, wall_z};
  wall.request.look_move = {0.4, 0, 0};
  const double turn = std::atan(0.4 / wall_z);
  for_each_flow(wall.flow(), [&](double x, double y, double right, double down) {
    const double ahead = x * std::sin(turn) + std::cos(turn);
    EXPECT_NEAR(right, focal_px * ((x * std::cos(turn) - std::sin(turn)) / ahead - x), flow_error_px);
    EXPECT_NEAR(down, focal_px * (y / ahead - y), flow_error_px);
  });
}

TEST(SceneFlow, ThroughALensSeesThePointThatThePixelSaw) {
  Wall wall;
  wall.give_lens();
  wall.request.camera_move = wall.request.look_move = {0.08, 0.05, 0};
  const PreparedScene scene = prepare_scene(wall.request);
  const std::vector<float> rays = rays_seen(scene), flow = flow_seen(scene);
  const auto ray = [&](int column, int row, int axis) {
    return static_cast<double>(
        rays[2 * static_cast<std::size_t>(row * columns + column) + static_cast<std::size_t>(axis)]);
  };
  // Where the camera moves sideways, tangents change by its way over the distance from the entrance pupil,
  // which is within 0.1 of the film: the same everywhere.
  int checked = 0;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const std::size_t at = 2 * static_cast<std::size_t>(row * columns + column);
      const double x = column + static_cast<double>(flow[at]), y = row + static_cast<double>(flow[at + 1]);
      if (!(x >= 0 && x < columns - 1 && y >= 0 && y < rows - 1)) continue;
      const int left = static_cast<int>(x), top = static_cast<int>(y);
      const double u = x - left, v = y - top;
      for (const int axis : {0, 1}) {
        const double there = (1 - v) * ((1 - u) * ray(left, top, axis) + u * ray(left + 1, top, axis)) +
                             v * ((1 - u) * ray(left, top + 1, axis) + u * ray(left + 1, top + 1, axis));
        const double way = axis == 0 ? 0.08 : -0.05, distance = way / (ray(column, row, axis) - there);
        EXPECT_GT(distance, wall_z - 0.11);
        EXPECT_LT(distance, wall_z + 0.01);
      }
      ++checked;
    }
  EXPECT_GT(checked, columns * rows / 2);
  // Tangents of a lens that hardly distorts: f = 50 mm on a film 20 mm across the diagonal.
  EXPECT_NEAR(ray(columns - 1, rows - 1, 0) / ray(columns - 1, rows - 1, 1), 15.5 / 11.5, 1e-3);
  EXPECT_NEAR(ray(columns - 1, rows / 2, 0), 15.5 * 20 / 40 / 51.6, 0.02 * 0.15);
}

TEST(SceneFlow, IsOfACameraThatMoves) {
  const Wall wall;
  EXPECT_THROW(wall.flow(), InputError);
  Wall still;
  still.request.rolling_shutter = 0.5;
  EXPECT_THROW(still.flow(), InputError);
}

/// A luminous half of the wall, left of the middle.
const char* const half = "AreaLightSource \"diffuse\" \"rgb L\" [ 1 1 1 ]\n";

/// Light of a row, its left end 1: where the edge is [pixels].
double edge_of_row(const Rendering& picture, int row) {
  double sum = 0;
  const float* light = picture.irradiance.band(0).data() + row * columns;
  for (int column = 0; column < columns; ++column) sum += static_cast<double>(light[column]);
  return sum / static_cast<double>(light[0]);
}

TEST(MotionBlur, OfAnEdgeIsItsWay) {
  Wall wall(scene_text(half, "0 -9 2  -9 -9 2  0 9 2  -9 9 2"));
  wall.request.samples_per_pixel = 256;
  wall.request.camera_move = wall.request.look_move = {0.4, 0, 0};
  const double way_px = focal_px * 0.4 / wall_z;
  ASSERT_GT(way_px, 5);
  const Rendering picture = render_scene(wall.request);
  for (int column = 0; column < columns; ++column) {
    double sum = 0, expected = 0;
    for (int row = 0; row < rows; ++row)
      sum +=
          static_cast<double>(picture.irradiance.band(0)[static_cast<std::size_t>(row * columns + column)]);
    sum /= rows * static_cast<double>(picture.irradiance.band(0)[0]);
    constexpr int instants = 1000;
    for (int i = 0; i < instants; ++i)
      expected += std::clamp(columns / 2.0 - way_px * (i + 0.5) / instants - column, 0.0, 1.0) / instants;
    // Five standard errors of 24 · 256 samples that are light or dark.
    EXPECT_NEAR(sum, expected, 5 * 0.5 / std::sqrt(rows * 256.0)) << column;
  }
}

TEST(MotionBlur, OfARollingShutterSlantsTheEdge) {
  Wall wall(scene_text(half, "0 -9 2  -9 -9 2  0 9 2  -9 9 2"));
  wall.request.samples_per_pixel = 256;
  wall.request.camera_move = wall.request.look_move = {0.4, 0, 0};
  const double rolling = wall.request.rolling_shutter = 0.75, way_px = focal_px * 0.4 / wall_z;
  const Rendering picture = render_scene(wall.request);
  for (int row = 0; row < rows; ++row) {
    const double middle = rolling * row / (rows - 1) + (1 - rolling) / 2;
    // Five standard errors of the light of at most four pixels.
    EXPECT_NEAR(edge_of_row(picture, row), columns / 2.0 - way_px * middle, 5 * 0.5 * 2 / 16) << row;
  }
}

TEST(RenderSharp, HasTheLightOfTheWholeStopWithoutItsBlur) {
  Wall wall(scene_text(
      "LightSource \"infinite\"\nTexture \"t\" \"spectrum\" \"checkerboard\" \"float uscale\" 360 \"float "
      "vscale\" 360 "
      "\"rgb tex1\" [ .9 .9 .9 ] \"rgb tex2\" [ .1 .1 .1 ]\nMaterial \"diffuse\" \"texture "
      "reflectance\" \"t\"\n"));
  wall.give_lens();
  wall.request.camera.focus = Focus::at_m(0.4);
  wall.request.samples_per_pixel = 256;
  const PreparedScene scene = prepare_scene(wall.request);
  const auto middle = [](const Rendering& picture) {
    std::vector<double> light;
    for (int row = rows / 4; row < 3 * rows / 4; ++row)
      for (int column = columns / 4; column < 3 * columns / 4; ++column)
        light.push_back(static_cast<double>(
            picture.irradiance.band(0)[static_cast<std::size_t>(row * columns + column)]));
    std::sort(light.begin(), light.end());
    return light;
  };
  const std::vector<double> blurred = middle(render_scene(scene)), sharp = middle(render_sharp(scene));
  const auto mean = [](const std::vector<double>& light) {
    double sum = 0;
    for (const double each : light) sum += each;
    return sum / static_cast<double>(light.size());
  };
  // Squares are 50 mm wide; the cone of light is 100 mm wide where it meets them.
  EXPECT_NEAR(mean(sharp) / mean(blurred), 1, 0.05);
  // 0.9 against 0.1, if less where light that the wall itself scatters comes in.
  const auto contrast = [](const std::vector<double>& light) {
    return light[9 * light.size() / 10] / light[light.size() / 10];
  };
  EXPECT_GT(contrast(sharp), 6);
  EXPECT_LT(contrast(blurred), contrast(sharp) / 2);
}

}  // namespace
}  // namespace petzval
