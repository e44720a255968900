// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/scene/named_chart.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace petzval {

namespace {

int whole(double parameter, const char* chart) {
  if (!(parameter >= 1 && parameter <= 1e6) || parameter != std::floor(parameter))
    throw InputError(fmt::format("{}:{}: a whole number from 1 up would be right", chart, parameter));
  return static_cast<int>(parameter);
}

constexpr std::array all_charts = {
    NamedChart{"cards", "", "three cards before a wall with lamps, at four depths",
               [](const ChartOptions& options, std::optional<double>) { return cards_chart(options); }, true},
    NamedChart{"checkerboard", "N", "black and white squares, N (16) across",
               [](const ChartOptions& options, std::optional<double> n) {
                 return checkerboard_chart(options, whole(n.value_or(16), "checkerboard"));
               }},
    NamedChart{
        "colorchecker", "", "the 24 patches of a ColorChecker, measured reflectances",
        [](const ChartOptions& options, std::optional<double>) { return colorchecker_chart(options); }},
    NamedChart{"grid", "N", "dark lines on white, N (16) squares across",
               [](const ChartOptions& options, std::optional<double> n) {
                 return grid_chart(options, whole(n.value_or(16), "grid"));
               }},
    NamedChart{"points", "N", "N x N (9 x 9) white samples on black",
               [](const ChartOptions& options, std::optional<double> n) {
                 return point_chart(options, whole(n.value_or(9), "points"));
               }},
    NamedChart{"slanted-edge", "DEGREES", "a dark and a light half, the edge 5 degrees from the vertical",
               [](const ChartOptions& options, std::optional<double> angle) {
                 return slanted_edge_chart(options, angle.value_or(5));
               }},
    NamedChart{
        "slanted-plane", "", "a checkerboard that recedes from left to right, with depth",
        [](const ChartOptions& options, std::optional<double>) { return slanted_plane_chart(options); },
        true},
    NamedChart{"studio", "", "ColorChecker, greys, slanted edges, stars, bars, lettering on a line grid",
               [](const ChartOptions& options, std::optional<double>) { return studio_chart(options); }},
    NamedChart{"wall", "", "white everywhere",
               [](const ChartOptions& options, std::optional<double>) { return wall_chart(options); }},
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

Scene make_chart(const std::string& text, const NamedChart& chart, const ChartOptions& options) {
  const std::size_t colon = text.find(':');
  std::optional<double> parameter;
  if (colon != std::string::npos) {
    parameter = parse_number(std::string_view(text).substr(colon + 1));
    if (!*chart.parameter || !parameter)
      throw InputError(fmt::format("scene {}: {} would be right", text, shown_name(chart)));
  }
  Scene scene = chart.make(options, parameter);
  scene.name = text;
  return scene;
}

}  // namespace petzval
