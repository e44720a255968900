// SPDX-License-Identifier: BSD-3-Clause
// Curves over the field, a wavelength each; used by analysis_plots.cpp and pupil_plots.cpp.
#pragma once

#include <fmt/format.h>
#include <petzval/analysis/field_values.h>
#include <petzval/report/colours.h>
#include <petzval/report/svg_plot.h>

#include <algorithm>
#include <string>
#include <vector>

namespace petzval {

inline std::string field_text(Fields::Kind kind, double field) {
  return fmt::format("{:g}{}", field, kind == Fields::Kind::angle_deg ? "°" : " mm");
}

inline std::string wavelength_text(double wavelength_nm) {
  return fmt::format("{:g} nm", wavelength_nm);
}

inline PlotAxis field_axis(Fields::Kind kind) {
  std::string name = to_string(kind);
  name = name.substr(0, name.rfind('_'));
  std::replace(name.begin(), name.end(), '_', ' ');
  return {name == "angle" ? "field angle" : name, field_unit(kind)};
}

/// How many of rows [field][wavelength] belong to the first field.
template <class Row>
std::size_t wavelengths_of(const std::vector<Row>& rows) {
  std::size_t count = 0;
  while (count < rows.size() && rows[count].field == rows[0].field) ++count;
  return std::max<std::size_t>(count, 1);
}

/// One curve a wavelength through rows [field][wavelength], coloured as the wavelength.
template <class Row, class X, class Y>
void add_curves(Plot& plot, const std::vector<Row>& rows, X&& x, Y&& y, PlotStroke stroke = PlotStroke::solid,
                bool labelled = true) {
  const std::size_t wavelengths = wavelengths_of(rows);
  for (std::size_t w = 0; w < wavelengths && w < rows.size(); ++w) {
    std::vector<double> xs, ys;
    for (std::size_t i = w; i < rows.size(); i += wavelengths) {
      xs.push_back(x(rows[i]));
      ys.push_back(y(rows[i]));
    }
    PlotSeries& line = plot.line(labelled ? wavelength_text(rows[w].wavelength_nm) : "", xs, ys);
    line.colour = wavelength_colour(rows[w].wavelength_nm).hex();
    line.stroke = stroke;
  }
}

}  // namespace petzval
