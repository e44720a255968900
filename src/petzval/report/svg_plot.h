// SPDX-License-Identifier: BSD-3-Clause
// Plots as SVG text that needs nothing from outside: no fonts, no scripts, no files.
#pragma once

#include <petzval/report/ticks.h>

#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// One axis. Without `from` and `to` the range is that of the data, grown to the next tick.
struct PlotAxis {
  std::string label;
  std::string unit{};  ///< "mm"; shown in brackets after the label
  PlotScale scale = PlotScale::linear;
  std::optional<double> from{}, to{};
};

enum class PlotStroke { none, solid, dashed, dotted };
enum class PlotMarker { none, dot, circle, square, cross };

/// Points in the order in which they are joined. A point that is not finite (or not positive on a logarithmic
/// axis) breaks the line and is not drawn.
struct PlotSeries {
  std::string label;  ///< in the legend; empty: not there
  std::vector<double> x, y;
  PlotStroke stroke = PlotStroke::solid;
  PlotMarker marker = PlotMarker::none;
  std::string colour;  ///< "#rrggbb"; empty: the next of series_colour()
  double width_px = 1.8;
};

/// A text at a place in the plot.
struct PlotNote {
  double x = 0, y = 0;
  std::string text;
  bool to_the_left = false;  ///< the text ends at the place instead of beginning there
};

/// A straight line across the whole plot.
struct PlotGuide {
  enum class At { x, y };
  At at = At::y;
  double value = 0;
  std::string label{};
};

/// A picture beneath the lines, its edges at these places of the axes. Pixels are not smoothed.
struct PlotImage {
  std::string png;
  double left = 0, right = 1, bottom = 0, top = 1;
};

/// A plot: set what it shows, then ask for the SVG.
///
///     Plot plot;
///     plot.title = "Relative illumination at 587.6 nm";
///     plot.x = {"real image height", "mm"};
///     plot.y = {"relative illumination", ""};
///     plot.y.from = 0;
///     plot.line("edmund-54852", height_mm, illumination);
///     plot.line("cos⁴", height_mm, cos4).stroke = PlotStroke::dashed;
///     write_whole_file("illumination.svg", plot.svg());
///
/// The same plot gives the same bytes everywhere.
struct Plot {
  std::string title;
  PlotAxis x, y;
  std::vector<PlotSeries> series;
  std::vector<PlotNote> notes;
  std::vector<PlotGuide> guides;
  std::vector<PlotImage> images;
  double width_px = 640, height_px = 400;
  bool grid = true;
  bool equal_aspect = false;  ///< one unit is as long in x as in y; the height of the plot follows from that

  /// Adds a line; the reference is good until the next is added.
  PlotSeries& line(std::string label, std::vector<double> x_values, std::vector<double> y_values);
  /// Adds unconnected markers.
  PlotSeries& scatter(std::string label, std::vector<double> x_values, std::vector<double> y_values);

  /// \throws InputError if the x and y of a series differ in number.
  std::string svg() const;
};

/// Plots side by side in rows of `columns`, under one title, as one drawing.
std::string plot_grid_svg(const std::vector<Plot>& plots, int columns, const std::string& title);

}  // namespace petzval
