// SPDX-License-Identifier: BSD-3-Clause
// Charts by name.
#pragma once

#include <petzval/scene/chart_figures.h>
#include <petzval/scene/charts.h>

#include <optional>
#include <span>
#include <string>

namespace petzval {

/// A chart, with the parameter that may follow its name and a colon.
struct NamedChart {
  const char* name;
  const char* parameter;  ///< "" if it takes none
  const char* description;
  Scene (*make)(const ChartOptions& options, const ChartParameter& parameter) = nullptr;
  bool deep = false;  ///< stands at a finite distance, with depth
  /// Of a chart that is nothing but figures, in place of `make`.
  FigureChart (*figures)(ChartFrame frame, const ChartParameter& parameter) = nullptr;
  bool takes_text = false;  ///< else a number
  bool is_sky = false;      ///< shines by itself, at infinity, where it is
};

/// Sorted by name.
std::span<const NamedChart> named_charts();
/// "checkerboard[:N]"
std::string shown_name(const NamedChart& chart);
/// The chart that a text such as "points:5" means, or none.
const NamedChart* find_chart(const std::string& text);
/// What follows the colon of such a text. \throws InputError for a parameter that the chart does not take.
ChartParameter chart_parameter(const std::string& text, const NamedChart& chart);
/// The chart with the parameter that the text says. \throws InputError for a bad one, saying what would be
/// right.
Scene make_chart(const std::string& text, const NamedChart& chart, const ChartOptions& options);

}  // namespace petzval
