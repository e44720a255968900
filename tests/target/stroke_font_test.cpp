// SPDX-License-Identifier: BSD-3-Clause
// Letters as polygons, and the charts that are made of polygons.
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/target/stroke_font.h>
#include <petzval/target/test_charts.h>
#include <petzval/target/visible_regions.h>

#include <cmath>

namespace petzval {
namespace {

const std::string all = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.,:;-+=/()'!?";

TEST(StrokeFont, EveryLetterIsMadeOfSimplePolygons) {
  for (const char letter : all)
    for (const double angle : {0.0, 33.0}) {
      TargetScene scene;
      scene.polygons = text_polygons(std::string(1, letter), {10, 20}, {24, angle, 0.25});
      EXPECT_NO_THROW(validate(scene)) << letter;
      EXPECT_EQ(scene.polygons[0].level, 0.25);
    }
}

TEST(StrokeFont, StrokesHaveTheirWidthAndLettersTheirPlace) {
  // A T: a bar of 8 and a stem of 12 grid units, 1.6 wide, with ends 0.8 beyond; 2 px to a unit. Where they
  // overlap counts once.
  TargetScene scene;
  scene.polygons = text_polygons("T", {100, 50}, {24, 0, 0});
  double area = 0;
  for (const Region& region : visible_regions(scene))
    for (const Contour& contour : region.contours) area += signed_area(contour);
  EXPECT_NEAR(area, 4 * (9.6 * 1.6 + 13.6 * 1.6 - 1.6 * 1.6), 1e-4);
  EXPECT_DOUBLE_EQ(text_width("TT", {24, 0, 0}), 2 * (8 + 11.5));
  EXPECT_DOUBLE_EQ(text_width("tt", {24, 0, 0}), 0.75 * 2 * (8 + 11.5));
  // Every letter stays within its cell, but for the stroke's own width.
  for (const char letter : all)
    for (const Polygon& polygon : text_polygons(std::string(1, letter), {0, 0}, {12, 0, 0}))
      for (const Contour& contour : polygon.contours)
        for (const Vertex& v : contour) {
          EXPECT_TRUE(v.x > -2.5 && v.x < 10.5) << letter;
          EXPECT_TRUE(v.y > -2.5 && v.y < 15.5) << letter;
        }
}

TEST(StrokeFont, RefusesWhatHasNoShape) {
  for (const char* text : {"\xc3\xa9", "a_b", "\n", "   ", ""})
    EXPECT_THROW(text_polygons(text, {0, 0}, {20, 0, 0}), InputError) << text;
  for (const double height : {0.0, double{NAN}, 1e308}) {
    EXPECT_THROW(text_polygons("A", {0, 0}, {height, 0, 0}), InputError);
    EXPECT_THROW(text_width("Ab", {height, 0, 0}), InputError);
  }
}

TEST(TestCharts, AllAreSimplePolygonsWithinTheFrame) {
  for (const std::string& name : test_chart_names())
    for (const auto& [columns, rows] : {std::pair{64, 64}, {640, 480}, {200, 900}}) {
      const TargetScene scene = test_chart(name, columns, rows);
      EXPECT_NO_THROW(validate(scene)) << name;
      ASSERT_FALSE(scene.polygons.empty()) << name;
      for (const Polygon& polygon : scene.polygons)
        for (const Contour& contour : polygon.contours)
          for (const Vertex& v : contour)
            EXPECT_TRUE(v.x >= 0 && v.x <= columns && v.y >= 0 && v.y <= rows)
                << name << " " << v.x << " " << v.y;
    }
}

TEST(TestCharts, TrumpetHasItsFrequencies) {
  // Half-way down the bars are 1/(2·0.3) pixels wide.
  const TargetScene scene = test_chart("trumpet", 640, 640);
  const Contour& bar = scene.polygons[4].contours[0];  // the middle one
  for (const Vertex& v : bar) {
    const double share = (v.y / 640 - 0.08) / 0.84;
    EXPECT_NEAR(2 * std::abs(v.x - 320), 1 / (2 * (0.05 + 0.5 * share)), 1e-9);
  }
}

}  // namespace
}  // namespace petzval
