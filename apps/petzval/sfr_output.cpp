// SPDX-License-Identifier: BSD-3-Clause
#include "sfr_output.h"

#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/text_lines.h>
#include <petzval/base/units.h>
#include <petzval/base/whole_file.h>
#include <petzval/measure/sfr/sharpest_place.h>
#include <petzval/report/svg_plot.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "field_option.h"

namespace petzval::app {

namespace {

constexpr std::size_t most_curves = 12;

std::string name_of(const MeasuredEdge& edge, std::size_t index) {
  return edge.channel.empty() ? fmt::format("edge {}", index + 1)
                              : fmt::format("edge {}, {}", index + 1, edge.channel);
}

nlohmann::ordered_json edge_json(const MeasuredEdge& edge, const SfrReport& report) {
  nlohmann::ordered_json json = {{"angle_deg", edge.angle_deg()},
                                 {"mtf50_cpp", number_or_null(edge.mtf50())}};
  if (report.pitch_um) json["mtf50_lpmm"] = number_or_null(edge.mtf50() * 1e3 / *report.pitch_um);
  json["mtf50_lwph"] = number_or_null(2 * edge.mtf50() * report.rows);
  if (!edge.iso) json["mtf50_deviation_cpp"] = number_or_null(edge.exact.mtf50().deviation_cpp);
  if (!edge.channel.empty()) json["channel"] = edge.channel;
  if (edge.lateral_offset_px) json["lateral_offset_px"] = *edge.lateral_offset_px;
  if (edge.on_chart)
    json["on_chart"] = {{"x_mm", edge.on_chart->x_mm},
                        {"y_mm", edge.on_chart->y_mm},
                        {"mtf50_cpmm", number_or_null(edge.mtf50() * edge.on_chart->per_mm)}};
  if (!edge.iso) {
    for (const MtfLevel& level : edge.exact.mtf)
      json[fmt::format("mtf{:.0f}_cpp", 100 * level.level)] = number_or_null(level.frequency_cpp);
    json["dark"] = edge.exact.dark;
    json["bright"] = edge.exact.bright;
    json["noise_dark"] = edge.exact.noise_dark;
    json["noise_bright"] = edge.exact.noise_bright;
    json["rise_10_90_px"] = edge.exact.rise_px;
    json["overshoot"] = edge.exact.overshoot;
    json["undershoot"] = edge.exact.undershoot;
    json["tail_px"] = edge.exact.tail_px;
    json["samples"] = edge.exact.samples;
  }
  if (!edge.exact.notes.empty()) json["notes"] = edge.exact.notes;
  json["roi"] = {edge.roi.x, edge.roi.y, edge.roi.width, edge.roi.height};
  const EdgeLine& line = edge.exact.line;
  json["line"] = {{"x_px", line.centre_x},
                  {"y_px", line.centre_y},
                  {"normal_deg", degrees(line.normal_rad)},
                  {"half_length_px", line.half_length}};
  if (!edge.iso) json["level_correlations"] = edge.exact.level_correlations;
  json["frequencies_cpp"] = edge.frequencies();
  json["sfr"] = edge.sfr();
  if (!edge.iso) json["sfr_deviation"] = edge.exact.sfr_deviation;
  return json;
}

std::vector<ChannelFocus> focus_of(const SfrReport& report, const FocusQuestion& question) {
  try {
    return focus_along(report.edges, question.along == 'x' ? ChartAxis::x : ChartAxis::y);
  } catch (const InputError& error) {
    throw InputError(report.image, error.what());
  }
}

/// Of a place on a tilted chart, from its middle; where both are known.
std::optional<double> depth_of(const SfrReport& report, const FocusQuestion& question, double place_mm) {
  if (!question.tilt_deg || !report.chart_mm) return std::nullopt;
  return depth_on_tilted_chart(place_mm, (*report.chart_mm)[question.along == 'x' ? 0 : 1],
                               *question.tilt_deg);
}

nlohmann::ordered_json focus_json(const SfrReport& report, const FocusQuestion& question) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  const std::string unit = report.chart_mm ? "mm" : "px";
  for (const ChannelFocus& focus : focus_of(report, question)) {
    nlohmann::ordered_json one;
    if (!focus.channel.empty()) one["channel"] = focus.channel;
    one["along"] = std::string(1, question.along);
    one["place_" + unit] = focus.sharpest.place;
    one["deviation_" + unit] = focus.sharpest.deviation;
    if (const auto depth = depth_of(report, question, focus.sharpest.place)) one["depth_mm"] = *depth;
    one["edges"] = focus.sharpest.edges;
    json.push_back(one);
  }
  return json;
}

void print_focus(const SfrReport& report, const FocusQuestion& question) {
  const char* const unit = report.chart_mm ? "mm" : "px";
  for (const ChannelFocus& focus : focus_of(report, question)) {
    fmt::print("{}{}{}sharpest at {} = {:.2f} +- {:.2f} {}, by {} edges", report.image, ": ",
               focus.channel.empty() ? "" : focus.channel + " ", question.along, focus.sharpest.place,
               focus.sharpest.deviation, unit, focus.sharpest.edges);
    if (const auto depth = depth_of(report, question, focus.sharpest.place))
      fmt::print("; {:+.2f} mm in depth from the middle of the chart", *depth);
    fmt::print("\n");
  }
}

nlohmann::ordered_json edges_json(const SfrReport& report) {
  nlohmann::ordered_json json = {{"image", report.image}, {"columns", report.columns}, {"rows", report.rows}};
  if (!report.light.empty()) json["code_values"] = report.light;
  json["edges"] = nlohmann::ordered_json::array();
  for (const MeasuredEdge& edge : report.edges) json["edges"].push_back(edge_json(edge, report));
  return json;
}

nlohmann::ordered_json json_of(const SfrReports& reports) {
  const auto picture_json = [&](const SfrReport& report) {
    nlohmann::ordered_json json = edges_json(report);
    if (reports.focus) json["focus"] = focus_json(report, *reports.focus);
    return json;
  };
  if (reports.single) return picture_json(reports.pictures.front());
  nlohmann::ordered_json json = {{"pictures", nlohmann::ordered_json::array()},
                                 {"failed", nlohmann::ordered_json::array()}};
  for (const SfrReport& report : reports.pictures) json["pictures"].push_back(picture_json(report));
  for (const auto& [file, reason] : reports.failed)
    json["failed"].push_back({{"image", file}, {"reason", reason}});
  return json;
}

/// What several edges share is said once, with the names of the first.
void print_notes(const SfrReport& report, const Shared& shared) {
  constexpr std::size_t most_names = 3;
  std::map<std::string, std::vector<std::string>> edges_by_note;
  for (std::size_t i = 0; i < report.edges.size(); ++i)
    for (const std::string& text : report.edges[i].exact.notes)
      edges_by_note[text].push_back(name_of(report.edges[i], i));
  for (const auto& [text, names] : edges_by_note) {
    const std::size_t named = std::min(most_names, names.size());
    std::string edges =
        fmt::format("{}", fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(named), "; "));
    if (named < names.size()) edges += fmt::format(" and {} more", names.size() - named);
    note(shared, fmt::format("{}: {}: {}", report.image, edges, text));
  }
}

void print_edge(const SfrReport& report, std::size_t index) {
  const MeasuredEdge& e = report.edges[index];
  fmt::print("{:>4} {:>9} {:>12.4f} {:>11.5f} {:>10.5f} {:>12.1f} {:>10.5f} {:>10.3f}", index + 1,
             e.channel.empty() ? "-" : e.channel, e.angle_deg(), e.mtf50(),
             e.iso ? NAN : e.exact.mtf50().deviation_cpp, 2 * e.mtf50() * report.rows,
             e.iso ? NAN : e.exact.mtf[7].frequency_cpp, e.iso ? NAN : e.exact.rise_px);
  if (report.pitch_um) fmt::print("{:>15.3f}", e.mtf50() * 1e3 / *report.pitch_um);
  if (e.lateral_offset_px) fmt::print("  {:+.4f} px from green", *e.lateral_offset_px);
  if (e.on_chart)
    fmt::print("{:>11.2f} {:>10.2f} {:>16.4f}", e.on_chart->x_mm, e.on_chart->y_mm,
               e.mtf50() * e.on_chart->per_mm);
  fmt::print("\n");
}

/// A field of a .csv, in quotes where it must be.
std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

/// What rows of a table begin with.
std::string csv_file(const SfrReports& reports, const SfrReport& report) {
  return reports.single ? "" : csv_field(report.image) + ",";
}

std::string curve_file(const SfrReports& reports, const SfrReport& report) {
  return reports.single ? "" : std::filesystem::path(report.image).stem().string() + ", ";
}

/// Calls `draw` with the first edges of all pictures, as many as a plot can bear.
template <typename Draw>
void for_first_edges(const SfrReports& reports, const Draw& draw) {
  std::size_t curves = 0;
  for (const SfrReport& report : reports.pictures)
    for (std::size_t i = 0; i < report.edges.size() && curves < most_curves; ++i, ++curves) draw(report, i);
}

}  // namespace

void print_sfr(const SfrReports& reports, const Shared& shared) {
  for (const SfrReport& report : reports.pictures) print_notes(report, shared);
  if (shared.json) return print_json(json_of(reports));
  std::size_t width = 0;  // of the column of files
  for (const SfrReport& report : reports.pictures) {
    fmt::print("{}: {} x {} pixels, {} edge{}{}\n", report.image, report.columns, report.rows,
               report.edges.size(), report.edges.size() == 1 ? "" : "s",
               report.light.empty() ? "" : ", code values " + report.light);
    width = std::max({width, report.image.size(), std::size_t{4}});
  }
  if (!reports.single) fmt::print("{:<{}} ", "file", width);
  fmt::print("{:>4} {:>9} {:>12} {:>10} {:>10} {:>10} {:>10} {:>10}{}\n", "edge", "channel", "angle [deg]",
             "MTF50 [c/p]", "+- [c/p]", "MTF50[lw/ph]", "MTF20[c/p]", "rise [px]",
             (reports.pictures.front().pitch_um ? "  MTF50 [lp/mm]" : std::string()) +
                 (reports.pictures.front().chart_mm ? " chart x[mm] chart y[mm]  MTF50 [c/mm]" : ""));
  for (const SfrReport& report : reports.pictures)
    for (std::size_t i = 0; i < report.edges.size(); ++i) {
      if (!reports.single) fmt::print("{:<{}} ", report.image, width);
      print_edge(report, i);
    }
  if (reports.focus)
    for (const SfrReport& report : reports.pictures) print_focus(report, *reports.focus);
}

void write_sfr_csv(const std::string& path, const SfrReports& reports) {
  std::string text =
      fmt::format("{}edge,channel,frequency_cpp,{}frequency_lwph,sfr,deviation\n",
                  reports.single ? "" : "file,", reports.pictures.front().pitch_um ? "frequency_lpmm," : "");
  for (const SfrReport& report : reports.pictures)
    for (std::size_t i = 0; i < report.edges.size(); ++i) {
      const MeasuredEdge& edge = report.edges[i];
      for (std::size_t k = 0; k < edge.sfr().size(); ++k) {
        const double f = edge.frequencies()[k];
        text += fmt::format(
            "{}{},{},{:.6f},{}{:.3f},{:.8f},{}\n", csv_file(reports, report), i + 1, edge.channel, f,
            report.pitch_um ? fmt::format("{:.4f},", f * 1e3 / *report.pitch_um) : "", 2 * f * report.rows,
            edge.sfr()[k], edge.iso ? "" : fmt::format("{:.8f}", edge.exact.sfr_deviation[k]));
      }
    }
  write_whole_file(path, text);
}

void write_profile_csv(const std::string& path, const SfrReports& reports) {
  std::string text =
      fmt::format("{}edge,channel,distance_px,esf,lsf_per_px\n", reports.single ? "" : "file,");
  for (const SfrReport& report : reports.pictures)
    for (std::size_t i = 0; i < report.edges.size(); ++i) {
      const MeasuredEdge& edge = report.edges[i];
      for (std::size_t k = 0; k < edge.exact.esf.size(); ++k)
        text += fmt::format("{}{},{},{:.4f},{:.8f},{:.8f}\n", csv_file(reports, report), i + 1, edge.channel,
                            edge.exact.distance_px[k], edge.exact.esf[k], edge.exact.lsf[k]);
    }
  write_whole_file(path, text);
}

NamedCurve read_sfr_table(const std::string& path) {
  require_extension(path, {".csv"}, "an SFR to draw beside");
  constexpr std::size_t largest = std::size_t{64} << 20;
  const std::vector<TextLine> lines = text_lines(decoded_text(read_whole_file(path, largest)));
  const std::vector<std::string> names =
      lines.empty() ? std::vector<std::string>{} : split_at(lines[0].text, ',');
  const auto frequency = std::find(names.begin(), names.end(), "frequency_cpp"),
             sfr = std::find(names.begin(), names.end(), "sfr");
  if (frequency == names.end() || sfr == names.end())
    throw InputError(path, 1, "a heading with columns frequency_cpp and sfr is right");
  NamedCurve curve{std::filesystem::path(path).stem().string(), {}, {}};
  for (std::size_t i = 1; i < lines.size(); ++i) {
    if (lines[i].words.empty()) continue;
    const std::vector<std::string> parts = split_at(lines[i].text, ',');
    const auto number = [&](std::ptrdiff_t column) {
      double value = 0;
      const std::string text =
          static_cast<std::size_t>(column) < parts.size() ? parts[static_cast<std::size_t>(column)] : "";
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
      if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        throw InputError(path, lines[i].number, fmt::format("\"{}\" is no number", quotable(text)));
      return value;
    };
    const double f = number(frequency - names.begin());
    if (!curve.frequencies_cpp.empty() && f <= curve.frequencies_cpp.back()) break;
    curve.frequencies_cpp.push_back(f);
    curve.sfr.push_back(number(sfr - names.begin()));
  }
  if (curve.sfr.size() < 2) throw InputError(path, "two rows at least are needed to draw a curve");
  return curve;
}

std::string sfr_plot_svg(const SfrReports& reports, const std::vector<NamedCurve>& others) {
  Plot plot;
  plot.title = "Spatial frequency response";
  plot.x = {"spatial frequency", "cycles/pixel", PlotScale::linear, 0.0, 1.0};
  plot.y = {"SFR", "", PlotScale::linear, 0.0, std::nullopt};
  for_first_edges(reports, [&](const SfrReport& report, std::size_t i) {
    const std::string picture = reports.single && !others.empty()
                                    ? std::filesystem::path(report.image).stem().string() + ", "
                                    : curve_file(reports, report);
    plot.line(
        picture + fmt::format("{}: {:.2f} deg", name_of(report.edges[i], i), report.edges[i].angle_deg()),
        report.edges[i].frequencies(), report.edges[i].sfr());
  });
  for (std::size_t i = 0; i < others.size(); ++i)
    plot.line(others[i].name, others[i].frequencies_cpp, others[i].sfr).stroke =
        i % 2 == 0 ? PlotStroke::dashed : PlotStroke::dotted;
  plot.guides.push_back({PlotGuide::At::x, 0.5, "Nyquist"});
  return plot.svg();
}

std::string profile_plot_svg(const SfrReports& reports) {
  Plot plot;
  plot.title = "Edge spread";
  plot.x = {"distance from the edge", "pixels", PlotScale::linear, -10.0, 10.0};
  plot.y = {"level over the step", ""};
  for_first_edges(reports, [&](const SfrReport& report, std::size_t i) {
    std::vector<double> x, y;
    const EdgeMeasurement& edge = report.edges[i].exact;
    for (std::size_t k = 0; k < edge.esf.size(); ++k)
      if (std::abs(edge.distance_px[k]) <= 10) x.push_back(edge.distance_px[k]), y.push_back(edge.esf[k]);
    plot.line(curve_file(reports, report) + name_of(report.edges[i], i), x, y);
  });
  return plot.svg();
}

}  // namespace petzval::app
