// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/report/colours.h>
#include <petzval/report/sweep_plot.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace petzval {

namespace {

/// What analyses measure at: their values tell curves apart.
constexpr std::array<std::string_view, 14> places = {
    "field", "wavelength_nm", "frequency_cpmm",  "radius_um",     "zone",           "fan",         "pupil",
    "index", "surface",       "sensor_shift_mm", "first_surface", "second_surface", "azimuth_deg", "term"};

/// What a table is looked at for, the first that is there and changes.
constexpr std::array<std::string_view, 16> foremost = {"tangential",
                                                       "rms_radius_um",
                                                       "rms_waves",
                                                       "distortion_percent",
                                                       "relative_illumination",
                                                       "encircled_energy",
                                                       "tangential_mm",
                                                       "lateral_colour_um",
                                                       "open_share",
                                                       "chief_ray_angle_deg",
                                                       "levels.green.mean_e",
                                                       "levels.grey.mean_e",
                                                       "irradiance_max",
                                                       "efl_mm",
                                                       "bfl_mm",
                                                       "working_f_number"};

constexpr std::array<std::pair<std::string_view, std::string_view>, 10> units = {{{"_um", "µm"},
                                                                                  {"_mm", "mm"},
                                                                                  {"_nm", "nm"},
                                                                                  {"_deg", "°"},
                                                                                  {"_cpmm", "cycles/mm"},
                                                                                  {"_percent", "%"},
                                                                                  {"_waves", "waves"},
                                                                                  {"_dn", "DN"},
                                                                                  {"_e", "e"},
                                                                                  {"_s", "s"}}};

/// "rms_radius_um" as "rms radius" in µm.
PlotAxis axis_of_key(std::string key) {
  std::string unit;
  for (const auto& [ending, name] : units)
    if (key.size() > ending.size() && key.ends_with(ending)) {
      unit = name;
      key.resize(key.size() - ending.size());
      break;
    }
  std::replace(key.begin(), key.end(), '_', ' ');
  return {key, unit};
}

std::optional<std::size_t> column_of(const Table& rows, std::string_view key) {
  for (std::size_t i = 0; i < rows.columns.size(); ++i)
    if (rows.columns[i].key == key) return i;
  return {};
}

std::string text_of(const TableCell& cell) {
  if (const auto* number = std::get_if<double>(&cell)) return fmt::format("{:g}", *number);
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  return std::get<bool>(cell) ? "yes" : "no";
}

double number_of(const TableCell& cell) {
  const auto* number = std::get_if<double>(&cell);
  return number != nullptr ? *number : std::numeric_limits<double>::quiet_NaN();
}

std::vector<std::string> texts_of(const Table& rows, std::size_t column) {
  std::vector<std::string> texts;
  for (const auto& row : rows.rows) texts.push_back(text_of(row[column]));
  return texts;
}

bool changes(const Table& rows, std::size_t column) {
  const std::vector<std::string> texts = texts_of(rows, column);
  return std::ranges::any_of(texts, [&](const std::string& text) { return text != texts.front(); });
}

bool is_place(std::string_view key) {
  return std::ranges::find(places, key) != places.end();
}

/// A number and what stands behind it.
std::optional<std::pair<double, std::string>> value_with_unit(const std::string& text) {
  for (std::size_t length = text.size(); length > 0; --length)
    if (const auto number = parse_number(std::string_view(text).substr(0, length))) {
      const std::string unit = text.substr(length);
      if (std::ranges::all_of(unit, [](unsigned char c) { return std::isalpha(c) != 0 || c >= 0x80; }))
        return std::pair{*number, unit};
      return {};
    }
  return {};
}

/// What tells the curve of a row from others.
std::string curve_label(const Table& rows, std::size_t row, const std::vector<std::size_t>& by) {
  std::string label;
  for (const std::size_t column : by) {
    const std::string& key = rows.columns[column].key;
    const std::string value = text_of(rows.rows[row][column]);
    if (!label.empty()) label += ", ";
    if (key == "wavelength_nm")
      label += value + " nm";
    else if (key == "frequency_cpmm")
      label += value + "/mm";
    else if (const auto named = axis_of_key(key); !named.unit.empty())
      label += fmt::format("{} {} {}", named.label, value, named.unit);
    else
      label += fmt::format("{} {}", named.label, value);
  }
  return label;
}

struct Curve {
  std::string label;
  std::vector<std::pair<double, std::size_t>> points;  ///< x and the row
};

/// The values of a column that are drawn, as text; all where it is not named.
using DrawnValues = std::map<std::size_t, std::vector<std::string>>;

bool is_drawn(const Table& rows, std::size_t row, const std::vector<std::size_t>& by,
              const DrawnValues& drawn) {
  return std::ranges::all_of(by, [&](std::size_t column) {
    const std::string text = text_of(rows.rows[row][column]);
    const auto some = drawn.find(column);
    // A point that failed has no places.
    return !text.empty() &&
           (some == drawn.end() || std::ranges::find(some->second, text) != some->second.end());
  });
}

std::vector<Curve> curves_of(const Table& rows, const std::vector<double>& x,
                             const std::vector<std::size_t>& by, const DrawnValues& drawn) {
  std::vector<Curve> curves;
  std::map<std::string, std::size_t> known;
  for (std::size_t row = 0; row < rows.rows.size(); ++row) {
    if (!is_drawn(rows, row, by, drawn)) continue;
    const auto [entry, fresh] = known.emplace(curve_label(rows, row, by), curves.size());
    if (fresh) curves.push_back({entry->first, {}});
    curves[entry->second].points.emplace_back(x[row], row);
  }
  for (Curve& curve : curves)
    std::ranges::stable_sort(curve.points, {}, &std::pair<double, std::size_t>::first);
  return curves;
}

/// Leaves out values of the place that has most of them: three of many stay, then one of three; wavelengths
/// go first. \returns false if there is none to leave out.
bool thin_out(const Table& rows, const std::vector<std::size_t>& by, DrawnValues& drawn) {
  const auto values_of = [&](std::size_t column) {
    if (const auto some = drawn.find(column); some != drawn.end()) return some->second;
    std::vector<std::string> values;
    for (const std::string& text : texts_of(rows, column))
      if (!text.empty() && std::ranges::find(values, text) == values.end()) values.push_back(text);
    return values;
  };
  std::optional<std::size_t> chosen;
  std::size_t most = 1;
  for (const char* wavelengths_first : {"wavelength_nm", ""})
    for (const std::size_t column : by) {
      const std::string& key = rows.columns[column].key;
      const std::size_t count = values_of(column).size();
      if (!is_place(key) || count <= most || (*wavelengths_first != 0 && key != wavelengths_first)) continue;
      chosen = column;
      most = count;
    }
  if (!chosen) return false;
  const std::vector<std::string> all = values_of(*chosen);
  const std::size_t n = all.size();
  // The lowest of many frequencies is 0, which shows nothing.
  const std::size_t low = rows.columns[*chosen].key == "frequency_cpmm" ? n / 4 : 0;
  drawn[*chosen] = n > 3 ? std::vector{all[low], all[n / 2], all[n - 1]} : std::vector{all[n / 2]};
  return true;
}

void add_quantity(Plot& plot, const Table& rows, const std::vector<Curve>& curves, std::size_t column,
                  bool second) {
  for (std::size_t i = 0; i < curves.size(); ++i) {
    std::vector<double> x, y;
    for (const auto& [at, row] : curves[i].points) {
      x.push_back(at);
      y.push_back(number_of(rows.rows[row][column]));
    }
    PlotSeries& series = plot.line(second ? "" : curves[i].label, x, y);
    series.colour = series_colour(i).hex();
    series.stroke = second ? PlotStroke::dashed : PlotStroke::solid;
    series.marker = PlotMarker::dot;
  }
}

/// The quantity that is drawn dashed beside this one, if it is there.
std::optional<std::size_t> sagittal_of(const Table& rows, const std::string& key) {
  if (!key.starts_with("tangential")) return {};
  return column_of(rows, "sagittal" + key.substr(std::string_view("tangential").size()));
}

std::vector<std::string> chosen_quantities(const Table& rows, const std::vector<std::string>& measured,
                                           const std::vector<std::string>& of) {
  for (const std::string& key : of)
    if (std::ranges::find(measured, key) == measured.end())
      throw InputError(fmt::format("the sweep has no numbers {}; {} would be right", quotable(key),
                                   fmt::join(measured, ", ")));
  if (!of.empty()) return of;
  const auto moves = [&](std::string_view key) {
    return std::ranges::find(measured, key) != measured.end() && changes(rows, *column_of(rows, key));
  };
  for (const std::string_view key : foremost)
    if (moves(key)) return {std::string(key)};
  for (const std::string& key : measured)
    if (moves(key) && !key.ends_with("seconds")) return {key};
  if (measured.empty()) throw InputError("the sweep measured no numbers that could be drawn");
  return {measured.front()};
}

}  // namespace

std::optional<SweptAxis> swept_axis(const std::vector<std::string>& values) {
  SweptAxis axis;
  for (const std::string& text : values) {
    const auto value = value_with_unit(text);
    if (!value || !std::isfinite(value->first) || (!axis.values.empty() && value->second != axis.unit))
      return {};
    axis.values.push_back(value->first);
    axis.unit = value->second;
  }
  if (std::ranges::all_of(axis.values, [&](double value) { return value == axis.values.front(); })) return {};
  return axis;
}

std::vector<std::string> measured_columns(const Table& rows, const std::vector<std::string>& varied) {
  std::vector<std::string> keys;
  for (std::size_t i = 0; i < rows.columns.size(); ++i) {
    const std::string& key = rows.columns[i].key;
    if (is_place(key) || std::ranges::find(varied, key) != varied.end()) continue;
    if (std::ranges::any_of(rows.rows, [&](const auto& row) { return std::isfinite(number_of(row[i])); }))
      keys.push_back(key);
  }
  return keys;
}

std::vector<Plot> sweep_plots(const Table& rows, const std::vector<std::string>& varied,
                              const std::vector<std::string>& of, std::vector<std::string>* left_out) {
  rows.validate();
  std::optional<SweptAxis> axis;
  std::string over;
  for (const std::string& key : varied)
    if (const auto column = column_of(rows, key); column && (axis = swept_axis(texts_of(rows, *column)))) {
      over = key;
      break;
    }
  if (!axis)
    throw InputError(
        fmt::format("{} cannot be an axis of a plot; two or more numbers in one unit would be right",
                    varied.empty() ? "nothing" : fmt::format("{}", fmt::join(varied, ", "))));
  std::vector<std::size_t> by;
  for (std::size_t i = 0; i < rows.columns.size(); ++i) {
    const std::string& key = rows.columns[i].key;
    const bool tells = is_place(key) || std::ranges::find(varied, key) != varied.end();
    if (tells && key != over && changes(rows, i)) by.push_back(i);
  }
  constexpr std::size_t readable = 24, most_curves = 60;
  DrawnValues drawn;
  std::vector<Curve> curves = curves_of(rows, axis->values, by, drawn);
  while (curves.size() > readable && thin_out(rows, by, drawn))
    curves = curves_of(rows, axis->values, by, drawn);
  if (curves.size() > most_curves)
    throw InputError(fmt::format("a plot of {} curves; fewer values of {} (at most {} curves) would be right",
                                 curves.size(), fmt::join(varied, ", "), most_curves));
  for (const auto& [column, values] : drawn)
    if (left_out != nullptr)
      left_out->push_back(
          fmt::format("of {} only {} are drawn", rows.columns[column].key, fmt::join(values, ", ")));

  std::vector<Plot> plots;
  for (const std::string& key : chosen_quantities(rows, measured_columns(rows, varied), of)) {
    Plot plot;
    plot.x = axis_of_key(over);
    if (!axis->unit.empty()) plot.x.unit = axis->unit;
    plot.y = axis_of_key(key);
    if (key == "tangential") plot.y.label = "MTF, tangential";
    add_quantity(plot, rows, curves, *column_of(rows, key), false);
    const auto sagittal = of.size() > 1 ? std::nullopt : sagittal_of(rows, key);
    if (sagittal) {
      add_quantity(plot, rows, curves, *sagittal, true);
      plot.y.label += ", sagittal dashed";
    }
    plots.push_back(std::move(plot));
  }
  return plots;
}

}  // namespace petzval
