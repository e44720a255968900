// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <petzval/base/error.h>
#include <petzval/report/heat_map.h>
#include <petzval/report/svg_plot.h>

#include <cmath>
#include <random>
#include <regex>

#include "report/markup_checker.h"

namespace petzval {
namespace {

using test::has_non_finite_numbers;
using test::markup_fault;
using test::occurrences;

/// The groups of the n-th match of a pattern.
std::vector<std::string> matches(const std::string& text, const std::string& pattern, int group = 1) {
  const std::regex regex(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator i(text.begin(), text.end(), regex), end; i != end; ++i)
    found.push_back((*i)[group]);
  return found;
}

double only_number(const std::string& text, const std::string& pattern) {
  const auto found = matches(text, pattern);
  EXPECT_EQ(found.size(), 1u) << pattern;
  return found.empty() ? std::nan("") : std::stod(found[0]);
}

TEST(Plot, PutsPointsAtTheirTicks) {
  Plot plot;
  plot.scatter("", {0, 0.5, 3}, {0, 40, 100});
  const std::string svg = plot.svg();
  const auto x = matches(svg, "<circle cx=\"([-0-9.]+)\""), y = matches(svg, "<circle .*?cy=\"([-0-9.]+)\"");
  ASSERT_EQ(x.size(), 3u);
  const double tick_x =
      only_number(svg, "<text class=\"pz-ink\" x=\"([0-9.]+)\" y=\"[0-9.]+\" text-anchor=\"middle\">0\\.5<");
  const double tick_y =
      only_number(svg, "<text class=\"pz-ink\" x=\"[0-9.]+\" y=\"([0-9.]+)\" text-anchor=\"end\">40<");
  EXPECT_NEAR(std::stod(x[1]), tick_x, 0.02);      // two decimals are written
  EXPECT_NEAR(std::stod(y[1]), tick_y - 4, 0.02);  // labels hang 4 px below their tick
  EXPECT_LT(std::stod(y[2]), std::stod(y[0]));     // up is up
}

TEST(Plot, LogarithmicAxesAreLogarithmic) {
  Plot plot;
  plot.x.scale = plot.y.scale = PlotScale::logarithmic;
  plot.scatter("", {1, 10, 100, 1000}, {1e-6, 1e-4, 1e-2, 1});
  const std::string svg = plot.svg();
  const auto x = matches(svg, "<circle cx=\"([-0-9.]+)\""), y = matches(svg, "<circle .*?cy=\"([-0-9.]+)\"");
  ASSERT_EQ(x.size(), 4u);
  for (std::size_t i = 2; i < 4; ++i) {
    EXPECT_NEAR(std::stod(x[i]) - std::stod(x[i - 1]), std::stod(x[1]) - std::stod(x[0]), 0.03);
    EXPECT_NEAR(std::stod(y[i]) - std::stod(y[i - 1]), std::stod(y[1]) - std::stod(y[0]), 0.03);
  }
}

TEST(Plot, BreaksTheLineAtGaps) {
  const double nan = std::nan(""), inf = INFINITY;
  Plot plot;
  plot.line("", {0, 1, 2, 3, 4, 5, 6}, {0, 1, nan, 3, inf, 5, 6});
  const std::string svg = plot.svg();
  EXPECT_FALSE(has_non_finite_numbers(svg));
  const auto paths = matches(svg, "<path class=\"pz-data\" d=\"([^\"]+)\"");
  ASSERT_EQ(paths.size(), 1u);
  EXPECT_EQ(occurrences(paths[0], "M"), 3);
  EXPECT_EQ(occurrences(paths[0], "h0"), 1);  // the lonely point at 3
  EXPECT_EQ(occurrences(paths[0], "L"), 2);
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
  const std::string svg = plot.svg();
  const auto x = matches(svg, "<circle cx=\"([-0-9.]+)\""), y = matches(svg, "<circle .*?cy=\"([-0-9.]+)\"");
  ASSERT_EQ(x.size(), 3u);
  EXPECT_NEAR(std::stod(x[1]) - std::stod(x[0]), std::stod(y[0]) - std::stod(y[2]), 0.03);
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
  const auto references = matches(svg, "(?:href|src)=\"(.{5})");
  ASSERT_EQ(references.size(), 1u);
  EXPECT_EQ(references[0], "data:");
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
  const auto colours = matches(svg, "<path class=\"pz-data\"[^>]*stroke=\"(#[0-9a-f]{6})\"");
  ASSERT_EQ(colours.size(), 3u);
  EXPECT_NE(colours[0], colours[1]);
  EXPECT_NE(colours[1], colours[2]);
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
