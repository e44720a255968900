// SPDX-License-Identifier: BSD-3-Clause
// Charts by name.
#pragma once

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
  Scene (*make)(const ChartOptions& options, std::optional<double> parameter);
  bool deep = false;  ///< stands at a finite distance, with depth
};

/// Sorted by name.
std::span<const NamedChart> named_charts();
/// "checkerboard[:N]"
std::string shown_name(const NamedChart& chart);
/// The chart that a text such as "points:5" means, or none.
const NamedChart* find_chart(const std::string& text);
/// The chart with the parameter that the text says. \throws InputError for a bad one, saying what would be
/// right.
Scene make_chart(const std::string& text, const NamedChart& chart, const ChartOptions& options);

}  // namespace petzval
