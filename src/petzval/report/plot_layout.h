// SPDX-License-Identifier: BSD-3-Clause
// Where everything in a plot goes; used by svg_plot.cpp.
#pragma once

#include <petzval/report/svg_plot.h>
#include <petzval/report/ticks.h>

#include <cmath>
#include <string>
#include <vector>

namespace petzval {

inline constexpr double legend_row_px = 19, legend_key_px = 26;

struct LegendEntry {
  std::size_t series;
  double x, row;
};

/// Positions in pixels. The frame is the inner rectangle, in which the data are drawn.
struct PlotLayout {
  double left = 0, top = 0, width = 0, height = 0;  ///< of the frame
  double total_width = 0, total_height = 0;
  PlotScale x_scale = PlotScale::linear, y_scale = PlotScale::linear;
  Ticks x, y;
  std::vector<std::string> colours;  ///< of the series
  std::vector<LegendEntry> legend;

  /// Whether a coordinate has a place on an axis of this scale.
  static bool drawable(PlotScale scale, double value) {
    return std::isfinite(value) && (scale == PlotScale::linear || value > 0);
  }
  bool drawable(double x_value, double y_value) const {
    return drawable(x_scale, x_value) && drawable(y_scale, y_value);
  }
  /// Pixels from the left and from the upper edge of the frame.
  double px(double value) const { return width * share(x_scale, x, value); }
  double py(double value) const { return height * (1 - share(y_scale, y, value)); }

 private:
  static double share(PlotScale scale, const Ticks& ticks, double value) {
    if (scale == PlotScale::linear) return (value - ticks.from) / (ticks.to - ticks.from);
    return std::log(value / ticks.from) / std::log(ticks.to / ticks.from);
  }
};

/// \throws InputError if the x and y of a series differ in number.
PlotLayout lay_out(const Plot& plot);

}  // namespace petzval
