// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/report/heat_map.h>
#include <petzval/report/svg_plot.h>

#include <cmath>
#include <random>

#include "report/markup_checker.h"

namespace petzval {
namespace {

using test::Element;
using test::elements;
using test::has_non_finite_numbers;
using test::markup_fault;
using test::occurrences;

/// The one text of a drawing that reads so.
Element text_reading(const std::string& svg, const std::string& content) {
  std::vector<Element> found;
  for (const Element& text : elements(svg, "text"))
    if (text.text == content) found.push_back(text);
  EXPECT_EQ(found.size(), 1u) << content;
  return found.at(0);
}

TEST(Plot, PutsPointsAtTheirTicks) {
  Plot plot;
  plot.scatter("", {0, 0.5, 3}, {0, 40, 100});
  const std::string svg = plot.svg();
  const auto points = elements(svg, "circle");
  ASSERT_EQ(points.size(), 3u);
  // Two decimals are written; labels of the y axis hang 4 px below their tick.
  EXPECT_NEAR(points[1].number("cx"), text_reading(svg, "0.5").number("x"), 0.02);
  EXPECT_NEAR(points[1].number("cy"), text_reading(svg, "40").number("y") - 4, 0.02);
  EXPECT_LT(points[2].number("cy"), points[0].number("cy"));  // up is up
}

TEST(Plot, LogarithmicAxesAreLogarithmic) {
  Plot plot;
  plot.x.scale = plot.y.scale = PlotScale::logarithmic;
  plot.scatter("", {1, 10, 100, 1000}, {1e-6, 1e-4, 1e-2, 1});
  const auto points = elements(plot.svg(), "circle");
  ASSERT_EQ(points.size(), 4u);
  for (const char* axis : {"cx", "cy"})
    for (std::size_t i = 2; i < 4; ++i)
      EXPECT_NEAR(points[i].number(axis) - points[i - 1].number(axis),
                  points[1].number(axis) - points[0].number(axis), 0.03);
}

TEST(Plot, BreaksTheLineAtGaps) {
  const double nan = std::nan(""), inf = INFINITY;
  Plot plot;
  plot.line("", {0, 1, 2, 3, 4, 5, 6}, {0, 1, nan, 3, inf, 5, 6});
  const std::string svg = plot.svg();
  EXPECT_FALSE(has_non_finite_numbers(svg));
  const auto paths = elements(svg, "path");
  ASSERT_EQ(paths.size(), 1u);
  EXPECT_EQ(occurrences(paths[0].attributes.at("d"), "M"), 3);
  EXPECT_EQ(occurrences(paths[0].attributes.at("d"), "h0"), 1);  // the lonely point at 3
  EXPECT_EQ(occurrences(paths[0].attributes.at("d"), "L"), 2);
}

TEST(Plot, LeavesOutWhatALogarithmicAxisCannotShow) {
  Plot plot;
  plot.y.scale = PlotScale::logarithmic;
  plot.scatter("", {0, 1, 2, 3}, {0, -1, 1, 10});
  EXPECT_EQ(occurrences(plot.svg(), "<circle "), 2);
  EXPECT_FALSE(has_non_finite_numbers(plot.svg()));
}

TEST(Plot, EqualAspectMakesACircleRound) {
  Plot plot;
  plot.equal_aspect = true;
  plot.x.from = -4;
  plot.x.to = 4;
  plot.y.from = -1;
  plot.y.to = 1;
  plot.scatter("", {0, 1, 0}, {0, 0, 1});
  const auto points = elements(plot.svg(), "circle");
  ASSERT_EQ(points.size(), 3u);
  EXPECT_NEAR(points[1].number("cx") - points[0].number("cx"),
              points[0].number("cy") - points[2].number("cy"), 0.03);
}

TEST(Plot, EscapesEveryText) {
  Plot plot;
  plot.title = "a < b";
  plot.x = {"x & y", "\"mm\""};
  plot.y = {"<script>alert(1)</script>", ""};
  plot.line("</svg>", {0, 1}, {0, 1}).colour = "\"/><bad";
  plot.notes.push_back({0.5, 0.5, "<note>"});
  plot.guides.push_back({PlotGuide::At::y, 0.5, "&guide"});
  const std::string svg = plot.svg();
  EXPECT_EQ(markup_fault(svg), "");
  for (const char* tag : {"<script", "<bad", "<note"}) EXPECT_EQ(svg.find(tag), std::string::npos) << tag;
  EXPECT_EQ(occurrences(svg, "</svg>"), 2);  // the drawing and its window on the data
}

TEST(Plot, LoadsNothing) {
  Plot plot;
  plot.images.push_back({heat_map_png(std::vector<float>{1, 2}, 2, 1), 0, 2, 0, 1});
  const std::string svg = plot.svg();
  const auto images = elements(svg, "image");
  ASSERT_EQ(images.size(), 1u);
  EXPECT_EQ(images[0].attributes.at("href").substr(0, 15), "data:image/png;");
  EXPECT_EQ(occurrences(svg, "href=") + occurrences(svg, "src="), 1);
  EXPECT_EQ(svg.find("url("), std::string::npos);
  EXPECT_EQ(svg.find("@import"), std::string::npos);
  EXPECT_EQ(occurrences(svg, " id=\""), 0);  // several drawings share a page
}

TEST(Plot, ShowsLegendsOfNamedSeriesInDifferentColours) {
  Plot plot;
  for (const char* label : {"first", "second", ""}) plot.line(label, {0, 1}, {0, 1});
  const std::string svg = plot.svg();
  EXPECT_EQ(occurrences(svg, ">first<"), 1);
  EXPECT_EQ(occurrences(svg, ">second<"), 1);
  const auto lines = elements(svg, "path");
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_NE(lines[0].attributes.at("stroke"), lines[1].attributes.at("stroke"));
  EXPECT_NE(lines[1].attributes.at("stroke"), lines[2].attributes.at("stroke"));
}

TEST(Plot, RefusesUnequalNumbers) {
  Plot plot;
  plot.line("bad", {0, 1}, {0});
  EXPECT_THROW(plot.svg(), InputError);
}

// Whatever the data, the drawing is well-formed, finite, and the same each time.
TEST(Plot, StandsAnyData) {
  std::mt19937_64 random(11);
  const double special[] = {std::nan(""), INFINITY, -INFINITY, 0, -0.0, 1e308, -1e308, 1e-320, 1, -1};
  for (int round = 0; round < 200; ++round) {
    Plot plot;
    plot.x.scale = round % 2 == 0 ? PlotScale::linear : PlotScale::logarithmic;
    plot.y.scale = round % 3 == 0 ? PlotScale::logarithmic : PlotScale::linear;
    plot.equal_aspect = round % 5 == 0;
    if (round % 7 == 0) plot.y.from = special[random() % 10];
    std::vector<double> x, y;
    for (std::size_t i = random() % 6; i > 0; --i) {
      x.push_back(special[random() % 10]);
      y.push_back(special[random() % 10]);
    }
    plot.line("line", x, y).marker = static_cast<PlotMarker>(round % 5);
    plot.guides.push_back({PlotGuide::At::x, special[random() % 10], "guide"});
    const std::string svg = plot.svg();
    EXPECT_EQ(markup_fault(svg), "");
    EXPECT_FALSE(has_non_finite_numbers(svg)) << svg;
    EXPECT_EQ(svg, plot.svg());
  }
}

}  // namespace
}  // namespace petzval
