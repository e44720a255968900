// SPDX-License-Identifier: BSD-3-Clause
// Printed charts, photographed in perspective by a pinhole of this test's own.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/measure/sfr/chart_mapping.h>
#include <petzval/measure/sfr/measure_picture.h>
#include <petzval/measure/sfr/sharpest_place.h>
#include <petzval/target/printed_chart.h>
#include <petzval/target/render_target.h>

#include <cmath>
#include <random>

namespace petzval {
namespace {

constexpr double chart_width_mm = 240, chart_height_mm = 180;

/// A pinhole camera before a chart that is turned about its middle: by `roll` in its plane, then by `yaw` and
/// `pitch` out of it.
struct Pinhole {
  double yaw_deg = 0, pitch_deg = 0, roll_deg = 0, distance_mm = 700, focal_px = 1700, centre_px = 500;

  Vertex seen(Vertex chart) const {
    const double cr = std::cos(radians(roll_deg)), sr = std::sin(radians(roll_deg));
    const double cy = std::cos(radians(yaw_deg)), sy = std::sin(radians(yaw_deg));
    const double cp = std::cos(radians(pitch_deg)), sp = std::sin(radians(pitch_deg));
    const double u = chart.x - chart_width_mm / 2, v = chart.y - chart_height_mm / 2;
    const double x1 = cr * u - sr * v, y1 = sr * u + cr * v;
    const double x2 = cy * x1, z2 = sy * x1;
    const double y3 = cp * y1 - sp * z2, z3 = sp * y1 + cp * z2 + distance_mm;
    return {centre_px + focal_px * x2 / z3, centre_px * 0.8 + focal_px * y3 / z3};
  }
};

PicturePlanes photograph_of(const TargetScene& chart, const Pinhole& pinhole) {
  TargetScene scene = chart;
  for (Polygon& polygon : scene.polygons)
    for (Contour& contour : polygon.contours)
      for (Vertex& v : contour) v = pinhole.seen(v);
  TargetOptions options;
  options.columns = 1000, options.rows = 800, options.pitch_um = 4.73;
  const TargetImage image = render_target(scene, *radial_pupil_otf({}, 550, 8), options);
  PicturePlanes picture;
  picture.columns = image.columns(), picture.rows = image.rows();
  picture.planes.push_back({image.columns(), image.rows(), image.values()});
  return picture;
}

// Wanted before measuring: places to 0.1 mm (a third of a pixel here), sharpness on the chart to 0.5 %, the
// bounds of edges measured in the picture being 0.1 % and perspective not linear over an edge.
TEST(ChartMapping, FindsEdgesWhereTheyStandOnTheChart) {
  const TargetScene chart = printed_chart("slanted-edges", chart_width_mm, chart_height_mm);
  for (const Pinhole& pinhole :
       {Pinhole{}, Pinhole{25, 0, 3}, Pinhole{-20, 15, -8}, Pinhole{10, -25, 95}, Pinhole{0, 0, 180}}) {
    SfrRequest request;
    request.chart_mm = std::array{chart_width_mm, chart_height_mm};
    const std::vector<MeasuredEdge> edges = measure_sfr(photograph_of(chart, pinhole), request);
    std::size_t matched = 0;
    for (const MeasuredEdge& edge : edges) {
      ASSERT_TRUE(edge.on_chart.has_value());
      // The nearest middle of a square's side.
      double nearest = HUGE_VAL, turn = 0;
      Vertex middle, along;
      for (const Polygon& polygon : chart.polygons) {
        const Contour& contour = polygon.contours.front();
        for (std::size_t i = 0; contour.size() == 4 && i < 4; ++i) {
          const Vertex a = contour[i], b = contour[(i + 1) % 4];
          const double d =
              std::hypot(0.5 * (a.x + b.x) - edge.on_chart->x_mm, 0.5 * (a.y + b.y) - edge.on_chart->y_mm);
          if (d >= nearest) continue;
          nearest = d, middle = {0.5 * (a.x + b.x), 0.5 * (a.y + b.y)}, along = {b.x - a.x, b.y - a.y};
        }
      }
      // Across the edge; along it the middle of the samples in perspective is not the middle of the side.
      const double length = std::hypot(along.x, along.y);
      const double across =
          ((edge.on_chart->x_mm - middle.x) * along.y - (edge.on_chart->y_mm - middle.y) * along.x) / length;
      EXPECT_LT(std::abs(across), 0.1);
      EXPECT_LT(nearest, 2);
      // Pixels across the edge in the picture, for a millimetre across it on the chart, by differences.
      const Vertex at{edge.on_chart->x_mm, edge.on_chart->y_mm};
      const double h = 0.01;
      const Vertex p = pinhole.seen(at),
                   q = pinhole.seen({at.x + h * along.y / length, at.y - h * along.x / length});
      const Vertex r = pinhole.seen({at.x + h * along.x / length, at.y + h * along.y / length});
      turn = std::atan2(r.y - p.y, r.x - p.x);
      const double pixels_per_mm = std::abs((q.x - p.x) * std::sin(turn) - (q.y - p.y) * std::cos(turn)) / h;
      EXPECT_NEAR(edge.on_chart->per_mm / pixels_per_mm, 1, 5e-3);
      ++matched;
    }
    EXPECT_GT(matched, 40) << pinhole.yaw_deg;  // of 48
  }
}

TEST(ChartMapping, SaysHowManyMarksAreMissing) {
  TargetScene chart = printed_chart("slanted-edges", chart_width_mm, chart_height_mm);
  chart.polygons.pop_back(), chart.polygons.pop_back();  // ring and dot of the last mark
  const PicturePlanes picture = photograph_of(chart, {});
  try {
    ChartMapping(picture.planes[0], chart_width_mm, chart_height_mm);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("3 of the chart's four marks"), std::string::npos)
        << error.what();
  }
}

// Edges as sharp as 1/m² = 4 + 0.02 (x − 31)² with 1 % of noise: within four stated deviations in all of
// fifty draws, and these about as large as the errors.
TEST(SharpestPlace, IsFoundAsWellAsItSays) {
  double squares = 0;
  for (unsigned seed = 0; seed < 50; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, 0.01);
    std::vector<SharpnessAt> edges;
    for (double x = 0; x <= 60; x += 4) {
      const double m = 1 / std::sqrt(4 + 0.02 * (x - 31) * (x - 31));
      edges.push_back({x, m * (1 + normal(random)), 0.01 * m});
    }
    const SharpestPlace found = sharpest_place(edges);
    EXPECT_NEAR(found.place, 31, 4 * found.deviation);
    EXPECT_NEAR(found.mtf50, 0.5, 0.01);
    squares += std::pow((found.place - 31) / found.deviation, 2) / 50;
  }
  EXPECT_GT(std::sqrt(squares), 0.7);
  EXPECT_LT(std::sqrt(squares), 1.3);
}

TEST(SharpestPlace, RefusesWhatHasNone) {
  const auto message = [](const std::vector<SharpnessAt>& edges) -> std::string {
    try {
      sharpest_place(edges);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message({{0, 0.3, 0.01}, {1, 0.3, 0.01}}).find("focus needs 4"), std::string::npos);
  std::vector<SharpnessAt> falling, flat;
  for (int i = 0; i < 8; ++i) {
    falling.push_back({i + 2.0, 1 / std::sqrt(4 + 0.2 * (i + 2) * (i + 2)), 0.001});
    flat.push_back({1.0 * i, 0.3 + 0.01 * i * i, 0.001});
  }
  EXPECT_NE(message(falling).find("beyond the edges"), std::string::npos) << message(falling);
  EXPECT_FALSE(message(flat).empty());
}

}  // namespace
}  // namespace petzval
