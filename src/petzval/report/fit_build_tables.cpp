// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/colour/colour_map.h>
#include <petzval/report/fit_build_tables.h>
#include <petzval/report/svg_plot.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace petzval {

namespace {

constexpr double arc_minutes = 60;

/// Dots in the frame, one colour for each of so many classes from the least to the most.
constexpr std::size_t colour_classes = 12;

struct MapRange {
  double low, high;
};

Plot dot_map(const FitBuildResult& result, const std::vector<double>& values, const MapRange& range,
             const std::string& title, int columns, int rows) {
  Plot plot;
  plot.title = title;
  const double half_x = 0.5 * columns, half_y = 0.5 * rows;
  plot.x = {"from the middle", "pixels", PlotScale::linear, -half_x, half_x};
  plot.y = {"up", "pixels", PlotScale::linear, -half_y, half_y};
  plot.equal_aspect = true;
  plot.width_px = 400;
  const std::array<Rgb8, 256> colours = colour_table(ColourMap::viridis);
  for (std::size_t c = 0; c < colour_classes; ++c) {
    std::vector<double> x, y;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double share = (values[i] - range.low) / (range.high - range.low);
      if (!std::isfinite(share)) continue;
      const auto at = static_cast<std::size_t>(std::clamp(share * colour_classes, 0.0, colour_classes - 1.0));
      if (at != c) continue;
      x.push_back(result.edges[i].x_px - half_x), y.push_back(half_y - result.edges[i].y_px);
    }
    if (!x.empty()) plot.scatter("", x, y).colour = colours[(2 * c + 1) * 128 / colour_classes].hex();
  }
  return plot;
}

/// \param per_degree, angle_unit  what angles are stated in.
Table numbers_table(const FitBuildResult& result, double per_degree, const std::string& angle_unit) {
  Table table{{{"number", "", 0, "number"},
               {"value", "", 4, "value"},
               {"+-", "", 4, "deviation"},
               {"unit", "", 0, "unit"}},
              {}};
  for (const FittedNumber& each : result.numbers) {
    const std::string unit = each.number.unit();
    const double factor = unit == "deg" ? per_degree : 1;
    table.rows.push_back({each.number.name(), factor * each.value, factor * each.deviation,
                          unit == "deg" ? angle_unit : unit});
  }
  return table;
}

std::vector<double> column_of(const FitBuildResult& result, double FittedEdge::*member) {
  std::vector<double> values;
  for (const FittedEdge& edge : result.edges) values.push_back(edge.*member);
  return values;
}

}  // namespace

Table fitted_numbers(const FitBuildResult& result) {
  return numbers_table(result, 1, "deg");
}

Table fitted_numbers_to_read(const FitBuildResult& result) {
  return numbers_table(result, arc_minutes, "arcmin");
}

Table fitted_edges(const FitBuildResult& result) {
  Table table{{{"photograph", "", 0, "photograph"},
               {"x", "px", 1, "x_px"},
               {"y", "px", 1, "y_px"},
               {"normal", "deg", 2, "normal_deg"},
               {"measured", "c/p", 4, "measured_cpp"},
               {"designed", "c/p", 4, "designed_cpp"},
               {"fitted", "c/p", 4, "fitted_cpp"}},
              {}};
  for (const FittedEdge& edge : result.edges)
    table.rows.push_back({edge.photograph + 1.0, edge.x_px, edge.y_px, edge.normal_deg, edge.measured_cpp,
                          edge.designed_cpp, edge.fitted_cpp});
  return table;
}

std::string fit_build_map_svg(const FitBuildResult& result, int columns, int rows) {
  const std::vector<double> measured = column_of(result, &FittedEdge::measured_cpp),
                            fitted = column_of(result, &FittedEdge::fitted_cpp);
  MapRange range{HUGE_VAL, 0};
  for (const double value : measured) range = {std::min(range.low, value), std::max(range.high, value)};
  if (!(range.high > range.low)) range = {0, range.high};
  std::vector<double> difference;
  for (std::size_t i = 0; i < measured.size(); ++i) difference.push_back(100 * (measured[i] / fitted[i] - 1));
  double most = 1;
  for (const double value : difference)
    if (std::isfinite(value)) most = std::max(most, std::abs(value));
  Plot against;
  against.title = "Edge by edge";
  against.x = {"fitted MTF50", "cycles/pixel", PlotScale::linear, 0.0};
  against.y = {"measured MTF50", "cycles/pixel", PlotScale::linear, 0.0};
  against.width_px = 400;
  against.scatter("as built", fitted, measured);
  against.scatter("as designed", column_of(result, &FittedEdge::designed_cpp), measured).marker =
      PlotMarker::circle;
  against.line("", {0, range.high}, {0, range.high}).stroke = PlotStroke::dashed;
  return plot_grid_svg(
      {dot_map(result, measured, range, "measured", columns, rows),
       dot_map(result, fitted, range, "fitted", columns, rows),
       dot_map(result, difference, {-most, most},
               fmt::format("measured over fitted, -{:.1f} to +{:.1f} %", most, most), columns, rows),
       against},
      2,
      fmt::format("{}: MTF50 from {:.3f} (dark) to {:.3f} (light) cycles/pixel", result.lens.name, range.low,
                  range.high));
}

}  // namespace petzval
