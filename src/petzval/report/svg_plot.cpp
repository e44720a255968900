// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/report/data_uri.h>
#include <petzval/report/plot_layout.h>
#include <petzval/report/svg_plot.h>
#include <petzval/report/xml.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

std::string axis_caption(const PlotAxis& axis, const Ticks& ticks) {
  std::string unit = ticks.exponent == 0
                         ? axis.unit
                         : power_of_ten(ticks.exponent) + (axis.unit.empty() ? "" : " " + axis.unit);
  if (unit.empty()) return axis.label;
  return axis.label.empty() ? unit : fmt::format("{} [{}]", axis.label, unit);
}

void draw_grid_and_ticks(XmlWriter& xml, const Plot& plot, const PlotLayout& layout) {
  const double right = layout.left + layout.width, bottom = layout.top + layout.height;
  const auto line = [&](const char* css, double x1, double y1, double x2, double y2) {
    xml.leaf("line", {{"class", css}, {"x1", x1}, {"y1", y1}, {"x2", x2}, {"y2", y2}});
  };
  for (std::size_t i = 0; i < layout.x.values.size(); ++i) {
    const double x = layout.left + layout.px(layout.x.values[i]);
    if (plot.grid) line("pz-grid", x, layout.top, x, bottom);
    line("pz-frame", x, bottom, x, bottom + 4);
    xml.text("text", {{"class", "pz-ink"}, {"x", x}, {"y", bottom + 18}, {"text-anchor", "middle"}},
             layout.x.labels[i]);
  }
  for (std::size_t i = 0; i < layout.y.values.size(); ++i) {
    const double y = layout.top + layout.py(layout.y.values[i]);
    if (plot.grid) line("pz-grid", layout.left, y, right, y);
    line("pz-frame", layout.left - 4, y, layout.left, y);
    xml.text("text", {{"class", "pz-ink"}, {"x", layout.left - 8}, {"y", y + 4}, {"text-anchor", "end"}},
             layout.y.labels[i]);
  }
  for (const double value : layout.x.minor)
    line("pz-frame", layout.left + layout.px(value), bottom, layout.left + layout.px(value), bottom + 2);
  for (const double value : layout.y.minor)
    line("pz-frame", layout.left - 2, layout.top + layout.py(value), layout.left,
         layout.top + layout.py(value));
}

void draw_frame_and_captions(XmlWriter& xml, const Plot& plot, const PlotLayout& layout) {
  xml.leaf("rect", {{"class", "pz-frame"},
                    {"x", layout.left},
                    {"y", layout.top},
                    {"width", layout.width},
                    {"height", layout.height}});
  xml.text("text",
           {{"class", "pz-ink"},
            {"x", layout.left + layout.width / 2},
            {"y", layout.top + layout.height + 40},
            {"text-anchor", "middle"},
            {"font-size", 13.0}},
           axis_caption(plot.x, layout.x));
  const double y_middle = layout.top + layout.height / 2;
  xml.text("text",
           {{"class", "pz-ink"},
            {"x", 16.0},
            {"y", y_middle},
            {"text-anchor", "middle"},
            {"font-size", 13.0},
            {"transform", fmt::format("rotate(-90 16 {})", svg_number(y_middle))}},
           axis_caption(plot.y, layout.y));
  if (!plot.title.empty())
    xml.text(
        "text",
        {{"class", "pz-ink"}, {"x", layout.left}, {"y", 24.0}, {"font-size", 15.0}, {"font-weight", "600"}},
        plot.title);
}

const char* dash_pattern(PlotStroke stroke) {
  return stroke == PlotStroke::dashed ? "7 4" : stroke == PlotStroke::dotted ? "1.5 4" : "";
}

/// "M…L…" in frame coordinates; a new M after each gap. A point alone between two gaps becomes a dot (round
/// caps).
std::string path_of(const PlotSeries& series, const PlotLayout& layout) {
  std::string path;
  std::size_t run = 0;
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (!layout.drawable(series.x[i], series.y[i])) {
      if (run == 1) path += "h0";
      run = 0;
      continue;
    }
    path += fmt::format("{}{} {}", run++ == 0 ? 'M' : 'L', svg_number(layout.px(series.x[i])),
                        svg_number(layout.py(series.y[i])));
  }
  if (run == 1) path += "h0";
  return path;
}

void draw_marker(XmlWriter& xml, PlotMarker marker, const std::string& colour, double x, double y) {
  constexpr double r = 3.4;
  if (marker == PlotMarker::dot) xml.leaf("circle", {{"cx", x}, {"cy", y}, {"r", r}, {"fill", colour}});
  if (marker == PlotMarker::circle)
    xml.leaf(
        "circle",
        {{"class", "pz-paper"}, {"cx", x}, {"cy", y}, {"r", r}, {"stroke", colour}, {"stroke-width", 1.6}});
  if (marker == PlotMarker::square)
    xml.leaf("rect", {{"x", x - r}, {"y", y - r}, {"width", 2 * r}, {"height", 2 * r}, {"fill", colour}});
  if (marker == PlotMarker::cross)
    xml.leaf("path", {{"d", fmt::format("M{0} {1}l7 7m0 -7l-7 7", svg_number(x - 3.5), svg_number(y - 3.5))},
                      {"stroke", colour},
                      {"stroke-width", 1.8}});
}

void draw_images(XmlWriter& xml, const Plot& plot, const PlotLayout& layout) {
  for (const PlotImage& image : plot.images) {
    const double x1 = layout.px(image.left), x2 = layout.px(image.right), y1 = layout.py(image.top),
                 y2 = layout.py(image.bottom);
    xml.leaf("image", {{"x", std::min(x1, x2)},
                       {"y", std::min(y1, y2)},
                       {"width", std::abs(x2 - x1)},
                       {"height", std::abs(y2 - y1)},
                       {"preserveAspectRatio", "none"},
                       {"style", "image-rendering:pixelated"},
                       {"href", data_uri("image/png", image.png)}});
  }
}

void draw_lines(XmlWriter& xml, const Plot& plot, const PlotLayout& layout) {
  // A nested drawing clips without a clip path, whose id would have to be unique in the page.
  xml.open("svg", {{"x", layout.left},
                   {"y", layout.top},
                   {"width", layout.width},
                   {"height", layout.height},
                   {"overflow", "hidden"}});
  draw_images(xml, plot, layout);
  for (const PlotGuide& guide : plot.guides) {
    const bool vertical = guide.at == PlotGuide::At::x;
    if (!PlotLayout::drawable(vertical ? layout.x_scale : layout.y_scale, guide.value)) continue;
    const double at = vertical ? layout.px(guide.value) : layout.py(guide.value);
    xml.leaf("line", {{"class", "pz-frame"},
                      {"x1", vertical ? at : 0},
                      {"y1", vertical ? 0 : at},
                      {"x2", vertical ? at : layout.width},
                      {"y2", vertical ? layout.height : at},
                      {"stroke-dasharray", "4 3"}});
    xml.text("text",
             {{"class", "pz-soft pz-note"},
              {"x", vertical ? at + 5 : layout.width - 6},
              {"y", vertical ? 14 : at - 5},
              {"text-anchor", vertical ? "start" : "end"},
              {"font-size", 11.0}},
             guide.label);
  }
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const PlotSeries& series = plot.series[i];
    if (series.stroke == PlotStroke::none) continue;
    xml.leaf("path", {{"class", "pz-data"},
                      {"d", path_of(series, layout)},
                      {"fill", "none"},
                      {"stroke", layout.colours[i]},
                      {"stroke-width", series.width_px},
                      {"stroke-linejoin", "round"},
                      {"stroke-linecap", "round"},
                      {"stroke-dasharray", dash_pattern(series.stroke)}});
  }
  xml.close();
}

void draw_markers_and_notes(XmlWriter& xml, const Plot& plot, const PlotLayout& layout) {
  constexpr double edge_px = 0.5;  // markers on the frame itself are drawn whole
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const PlotSeries& series = plot.series[i];
    if (series.marker == PlotMarker::none) continue;
    for (std::size_t k = 0; k < series.x.size(); ++k) {
      if (!layout.drawable(series.x[k], series.y[k])) continue;
      const double x = layout.px(series.x[k]), y = layout.py(series.y[k]);
      const bool inside =
          x >= -edge_px && x <= layout.width + edge_px && y >= -edge_px && y <= layout.height + edge_px;
      if (inside) draw_marker(xml, series.marker, layout.colours[i], layout.left + x, layout.top + y);
    }
  }
  for (const PlotNote& note : plot.notes)
    if (layout.drawable(note.x, note.y))
      xml.text("text",
               {{"class", "pz-ink pz-note"},
                {"x", layout.left + layout.px(note.x)},
                {"y", layout.top + layout.py(note.y)},
                {"text-anchor", note.to_the_left ? "end" : "start"}},
               note.text);
}

void draw_legend(XmlWriter& xml, const Plot& plot, const PlotLayout& layout) {
  const double first_row = plot.title.empty() ? 18 : 44;
  for (const LegendEntry& entry : layout.legend) {
    const PlotSeries& series = plot.series[entry.series];
    const double y = first_row + legend_row_px * entry.row;
    if (series.stroke != PlotStroke::none)
      xml.leaf("line", {{"x1", entry.x},
                        {"y1", y - 4},
                        {"x2", entry.x + legend_key_px - 6},
                        {"y2", y - 4},
                        {"stroke", layout.colours[entry.series]},
                        {"stroke-width", std::max(series.width_px, 1.8)},
                        {"stroke-linecap", "round"},
                        {"stroke-dasharray", dash_pattern(series.stroke)}});
    draw_marker(xml, series.marker, layout.colours[entry.series], entry.x + (legend_key_px - 6) / 2, y - 4);
    xml.text("text", {{"class", "pz-ink"}, {"x", entry.x + legend_key_px}, {"y", y}}, series.label);
  }
}

void draw_plot(XmlWriter& xml, const Plot& plot, const PlotLayout& layout) {
  draw_grid_and_ticks(xml, plot, layout);
  draw_lines(xml, plot, layout);
  draw_frame_and_captions(xml, plot, layout);
  draw_markers_and_notes(xml, plot, layout);
  draw_legend(xml, plot, layout);
}

}  // namespace

PlotSeries& Plot::line(std::string label, std::vector<double> x_values, std::vector<double> y_values) {
  PlotSeries added;
  added.label = std::move(label);
  added.x = std::move(x_values);
  added.y = std::move(y_values);
  return series.emplace_back(std::move(added));
}

PlotSeries& Plot::scatter(std::string label, std::vector<double> x_values, std::vector<double> y_values) {
  PlotSeries& added = line(std::move(label), std::move(x_values), std::move(y_values));
  added.stroke = PlotStroke::none;
  added.marker = PlotMarker::dot;
  return added;
}

std::string Plot::svg() const {
  const PlotLayout layout = lay_out(*this);
  XmlWriter xml;
  open_svg(xml, layout.total_width, layout.total_height,
           title.empty() ? y.label + " against " + x.label : title);
  draw_plot(xml, *this, layout);
  return std::move(xml).finish();
}

std::string plot_grid_svg(const std::vector<Plot>& plots, int columns, const std::string& title) {
  const double title_px = title.empty() ? 0 : 34;
  const std::size_t across = static_cast<std::size_t>(std::max(columns, 1));
  std::vector<PlotLayout> layouts;
  std::vector<double> column_x{0}, row_y{title_px};
  for (const Plot& plot : plots) layouts.push_back(lay_out(plot));
  for (std::size_t c = 0; c < std::min(across, plots.size()); ++c) {
    double widest = 0;
    for (std::size_t i = c; i < plots.size(); i += across) widest = std::max(widest, layouts[i].total_width);
    column_x.push_back(column_x.back() + widest);
  }
  for (std::size_t first = 0; first < plots.size(); first += across) {
    double tallest = 0;
    for (std::size_t i = first; i < std::min(first + across, plots.size()); ++i)
      tallest = std::max(tallest, layouts[i].total_height);
    row_y.push_back(row_y.back() + tallest);
  }
  XmlWriter xml;
  constexpr double px_a_character = 9.2;
  const double title_width = 24 + px_a_character * static_cast<double>(character_count(title));
  open_svg(xml, std::max(column_x.back(), title_width), row_y.back(), title);
  if (!title.empty())
    xml.text("text",
             {{"class", "pz-ink"}, {"x", 12.0}, {"y", 24.0}, {"font-size", 16.0}, {"font-weight", "600"}},
             title);
  for (std::size_t i = 0; i < plots.size(); ++i) {
    xml.open("svg", {{"x", column_x[i % across]},
                     {"y", row_y[i / across]},
                     {"width", layouts[i].total_width},
                     {"height", layouts[i].total_height}});
    draw_plot(xml, plots[i], layouts[i]);
    xml.close();
  }
  return std::move(xml).finish();
}

}  // namespace petzval
