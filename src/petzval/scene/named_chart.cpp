// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/scene/named_chart.h>
#include <petzval/scene/shape_cuts.h>
#include <petzval/scene/star_field.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace petzval {

namespace {

int whole(double parameter, const char* chart) {
  if (!(parameter >= 1 && parameter <= 1e6) || parameter != std::floor(parameter))
    throw InputError(fmt::format("{}:{}: a whole number from 1 to 1000000 would be right", chart, parameter));
  return static_cast<int>(parameter);
}

/// Figures in reflectances under the chart's light.
Scene painted(const FigureChart& chart, const ChartOptions& options) {
  ChartCanvas canvas(options);
  canvas.fill(canvas.flat_paint(chart.ground));
  for (const ChartFigure& figure : chart.figures) {
    canvas.draw(united(figure.outlines), canvas.flat_paint(figure.level));
  }
  return std::move(canvas).lit();
}

constexpr NamedChart of_figures(const char* name, const char* parameter, const char* description,
                                FigureChart (*figures)(ChartFrame, const ChartParameter&),
                                bool takes_text = false) {
  return {name, parameter, description, nullptr, false, figures, takes_text};
}

constexpr std::array all_charts = {
    NamedChart{"cards", "", "three cards before a wall with lamps, at four depths",
               [](const ChartOptions& options, const ChartParameter&) { return cards_chart(options); }, true},
    NamedChart{"checkerboard", "N", "black and white squares, N (16) across",
               [](const ChartOptions& options, const ChartParameter& n) {
                 return checkerboard_chart(options, whole(n.number.value_or(16), "checkerboard"));
               }},
    of_figures("chessboard", "N", "for calibration: N (10) squares across within a white margin",
               &chessboard_figures),
    NamedChart{
        "colorchecker", "", "the 24 patches of a ColorChecker, measured reflectances",
        [](const ChartOptions& options, const ChartParameter&) { return colorchecker_chart(options); }},
    of_figures("datamatrix", "TEXT", "a Data Matrix that says a text", &datamatrix_figures, true),
    NamedChart{"dead-leaves", "SEED", "discs of all sizes, one upon the other: texture without a scale",
               [](const ChartOptions& options, const ChartParameter& seed) {
                 return dead_leaves_chart(
                     options, static_cast<std::uint64_t>(whole(seed.number.value_or(1), "dead-leaves")));
               }},
    of_figures("dots", "N", "for calibration: dark discs on white, N (16) across", &dots_figures),
    NamedChart{"grid", "N", "dark lines on white, N (16) squares across",
               [](const ChartOptions& options, const ChartParameter& n) {
                 return grid_chart(options, whole(n.number.value_or(16), "grid"));
               }},
    of_figures("iso12233", "N", "after ISO 12233: slanted squares, wedges up to N line widths per height",
               &iso12233_figures),
    NamedChart{"points", "N", "N x N (9 x 9) white samples on black",
               [](const ChartOptions& options, const ChartParameter& n) {
                 return point_chart(options, whole(n.number.value_or(9), "points"));
               }},
    of_figures("qr", "TEXT", "a QR code that says a text", &qr_figures, true),
    of_figures("siemens", "N", "a star of N (36) dark sectors", &siemens_figures),
    of_figures("slanted-board", "N",
               "for MTFs all over the frame: squares, N (12) across, turned by 5 degrees",
               &slanted_board_figures),
    NamedChart{"slanted-edge", "DEGREES", "a dark and a light half, the edge 5 degrees from the vertical",
               [](const ChartOptions& options, const ChartParameter& angle) {
                 return slanted_edge_chart(options, angle.number.value_or(5));
               }},
    NamedChart{
        "slanted-plane", "", "a checkerboard that recedes from left to right, with depth",
        [](const ChartOptions& options, const ChartParameter&) { return slanted_plane_chart(options); },
        true},
    NamedChart{"stars", "PLACE",
               "real stars to magnitude 6 around orion, another constellation, or RA,DEC in degrees",
               [](const ChartOptions& options, const ChartParameter& place) {
                 return star_field(options, sky_place(place.text.empty() ? "orion" : place.text));
               },
               false, nullptr, true, true},
    NamedChart{"studio", "", "ColorChecker, greys, slanted edges, stars, bars, lettering on a line grid",
               [](const ChartOptions& options, const ChartParameter&) { return studio_chart(options); }},
    of_figures("usaf1951", "G", "bars of the USAF 1951 target from group G (-2) on: 24 mm/2^G wide at 4:3",
               &usaf_figures),
    NamedChart{"wall", "", "white everywhere",
               [](const ChartOptions& options, const ChartParameter&) { return wall_chart(options); }},
};

}  // namespace

std::span<const NamedChart> named_charts() {
  return all_charts;
}

std::string shown_name(const NamedChart& chart) {
  return *chart.parameter ? fmt::format("{}[:{}]", chart.name, chart.parameter) : chart.name;
}

const NamedChart* find_chart(const std::string& text) {
  const std::string name = text.substr(0, text.find(':'));
  const auto chart = std::find_if(all_charts.begin(), all_charts.end(),
                                  [&](const NamedChart& each) { return each.name == name; });
  return chart == all_charts.end() ? nullptr : &*chart;
}

ChartParameter chart_parameter(const std::string& text, const NamedChart& chart) {
  ChartParameter parameter;
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) return parameter;
  parameter.text = text.substr(colon + 1);
  parameter.number = parse_number(parameter.text);
  if (!*chart.parameter || parameter.text.empty() || (!chart.takes_text && !parameter.number))
    throw InputError(fmt::format("scene {}: {} would be right", text, shown_name(chart)));
  return parameter;
}

Scene make_chart(const std::string& text, const NamedChart& chart, const ChartOptions& options) {
  const ChartParameter parameter = chart_parameter(text, chart);
  Scene scene =
      chart.figures
          ? painted(chart.figures({double(options.columns), double(options.rows)}, parameter), options)
          : chart.make(options, parameter);
  scene.name = text;
  return scene;
}

}  // namespace petzval
