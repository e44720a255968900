// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/colour/display.h>
#include <petzval/report/data_uri.h>
#include <petzval/report/heat_map.h>
#include <petzval/report/html.h>
#include <petzval/report/sfr_page.h>
#include <petzval/report/svg_plot.h>
#include <petzval/report/table.h>
#include <petzval/report/xml.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace petzval {

namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

/// The edges that stand for the picture: of all channels, or green's.
std::vector<EdgeInFrame> leading_edges(const SfrPage& page) {
  std::vector<EdgeInFrame> all = edges_in_frame(page.edges, page.columns, page.rows);
  const bool green = std::ranges::any_of(all, [](const EdgeInFrame& e) { return e.channel == "green"; });
  std::erase_if(all, [&](const EdgeInFrame& e) { return green && e.channel != "green"; });
  return all;
}

std::vector<EdgeInFrame> of_direction(const std::vector<EdgeInFrame>& edges, EdgeDirection direction) {
  std::vector<EdgeInFrame> some;
  std::ranges::copy_if(edges, std::back_inserter(some),
                       [&](const EdgeInFrame& e) { return e.direction == direction; });
  return some;
}

double half_diagonal(const SfrPage& page) {
  return 0.5 * std::hypot(page.columns, page.rows);
}

struct Range {
  double low = 0, high = 1;
};

Range range_of(const std::vector<EdgeInFrame>& edges) {
  Range range{HUGE_VAL, 0};
  for (const EdgeInFrame& e : edges)
    range.low = std::min(range.low, e.mtf50_cpp), range.high = std::max(range.high, e.mtf50_cpp);
  return range.low < range.high ? range : Range{0, std::max(1e-3, range.high)};
}

Plot surface_plot(const SfrPage& page, const std::vector<EdgeInFrame>& edges, const Range& range,
                  const std::string& title) {
  Plot plot;
  plot.title = title;
  const double x = 0.5 * page.columns, y = 0.5 * page.rows;
  plot.x = {"from the middle", "pixels", PlotScale::linear, -x, x};
  plot.y = {"up", "pixels", PlotScale::linear, -y, y};
  plot.equal_aspect = true;
  plot.grid = false;
  plot.width_px = 460;
  const SharpnessSurface surface = sharpness_surface(edges, page.columns, page.rows);
  HeatMapOptions colours;
  colours.black = range.low, colours.white = range.high;
  plot.images.push_back(
      {heat_map_png(surface.mtf50_cpp, surface.columns, surface.rows, colours), -x, x, -y, y});
  std::vector<double> xs, ys;
  for (const EdgeInFrame& e : edges) xs.push_back(e.x_px), ys.push_back(e.y_px);
  plot.scatter("", xs, ys).colour = "#8c8c8c";
  return plot;
}

html::Block curves(const SfrPage& page) {
  Plot plot;
  plot.title = "Spatial frequency response";
  plot.x = {"spatial frequency", "cycles/pixel", PlotScale::linear, 0.0, 1.0};
  plot.y = {"SFR", "", PlotScale::linear, 0.0, std::nullopt};
  constexpr std::size_t most = 8;
  const std::size_t stride = 1 + (page.edges.size() - 1) / most;
  for (std::size_t i = 0; i < page.edges.size(); i += stride) {
    const MeasuredEdge& edge = page.edges[i];
    plot.line(fmt::format("edge {}{}{}", i + 1, edge.channel.empty() ? "" : ", ", edge.channel),
              edge.frequencies(), edge.sfr());
  }
  plot.guides.push_back({PlotGuide::At::x, 0.5, "Nyquist"});
  return html::figure(html::drawing(plot.svg()), stride > 1 ? "A few of the edges." : "All edges.");
}

Table edge_table(const SfrPage& page) {
  Table table{{{"edge", "", 0},
               {"x", "px", 0},
               {"y", "px", 0},
               {"angle", "deg", 2},
               {"MTF50", "cycles/px", 4},
               {"±", "cycles/px", 4},
               {"rise", "px", 2}},
              {}};
  const bool colours =
      std::ranges::any_of(page.edges, [](const MeasuredEdge& e) { return !e.channel.empty(); });
  if (page.pitch_um) table.columns.push_back({"MTF50", "lp/mm", 2});
  if (colours) table.columns.push_back({"channel", ""}), table.columns.push_back({"from green", "px", 3});
  for (std::size_t i = 0; i < page.edges.size(); ++i) {
    const MeasuredEdge& e = page.edges[i];
    std::vector<TableCell> row{static_cast<double>(i + 1),
                               e.exact.line.centre_x,
                               e.exact.line.centre_y,
                               e.angle_deg(),
                               e.mtf50(),
                               e.iso ? no_value : e.exact.mtf50().deviation_cpp,
                               e.exact.rise_px};
    if (page.pitch_um) row.emplace_back(e.mtf50() * 1e3 / *page.pitch_um);
    if (colours) row.emplace_back(e.channel), row.emplace_back(e.lateral_offset_px.value_or(no_value));
    table.rows.push_back(std::move(row));
  }
  return table;
}

html::Block summary(const SfrPage& page, const std::vector<EdgeInFrame>& edges) {
  std::vector<double> values;
  for (const EdgeInFrame& e : edges) values.push_back(e.mtf50_cpp);
  std::sort(values.begin(), values.end());
  const auto text = [](double value) { return fmt::format("{:.4f}", value); };
  std::vector<html::Fact> facts{{"picture", fmt::format("{} × {}", page.columns, page.rows), "pixels"},
                                {"edges", fmt::format("{}", edges.size())}};
  if (!values.empty()) {
    facts.push_back({"MTF50, median", text(values[values.size() / 2]), "cycles/pixel"});
    facts.push_back({"MTF50, lowest", text(values.front()), "cycles/pixel"});
    facts.push_back({"MTF50, highest", text(values.back()), "cycles/pixel"});
  }
  if (page.pitch_um) facts.push_back({"pixel pitch", fmt::format("{:g}", *page.pitch_um), "µm"});
  for (const char* colour : {"red", "blue"}) {
    const auto all = edges_in_frame(page.edges, page.columns, page.rows);
    if (const auto lateral = lateral_colour(all, colour, half_diagonal(page)))
      facts.push_back({fmt::format("{} in the corner", colour), fmt::format("{:+.3f}", lateral->at(1)),
                       "pixels farther out than green"});
  }
  return html::facts(facts);
}

}  // namespace

std::string annotated_edges_svg(const std::vector<MeasuredEdge>& edges, const Plane& luminance) {
  std::vector<float> levels;
  for (const double value : luminance.values) levels.push_back(static_cast<float>(srgb_encoded(value)));
  const std::string png = heat_map_png(levels, luminance.columns, luminance.rows, {});
  XmlWriter xml;
  open_svg(xml, luminance.columns, luminance.rows,
           "The picture with its edges and their MTF50 in cycles/pixel");
  xml.leaf("image", {{"width", static_cast<double>(luminance.columns)},
                     {"height", static_cast<double>(luminance.rows)},
                     {"href", data_uri("image/png", png)}});
  for (const MeasuredEdge& edge : edges) {
    const EdgeLine& line = edge.exact.line;
    const double ux = -std::sin(line.normal_rad) * line.half_length,
                 uy = std::cos(line.normal_rad) * line.half_length;
    xml.leaf("line", {{"x1", line.centre_x - ux},
                      {"y1", line.centre_y - uy},
                      {"x2", line.centre_x + ux},
                      {"y2", line.centre_y + uy},
                      {"stroke", "#e6550d"},
                      {"stroke-width", 1.5}});
    xml.text("text",
             {{"x", line.centre_x + 4},
              {"y", line.centre_y},
              {"fill", "#e6550d"},
              {"font-size", 12.0},
              {"font-family", "sans-serif"}},
             fmt::format("{:.3f}", edge.mtf50()));
  }
  return std::move(xml).finish();
}

std::string sharpness_map_svg(const SfrPage& page) {
  const std::vector<EdgeInFrame> edges = leading_edges(page);
  const Range range = range_of(edges);
  const auto named = [&](EdgeDirection direction, const char* name) {
    const std::vector<EdgeInFrame> some = of_direction(edges, direction);
    return surface_plot(page, some, range, fmt::format("{}: {} edges", name, some.size()));
  };
  return plot_grid_svg(
      {surface_plot(page, edges, range, fmt::format("all: {} edges", edges.size())),
       named(EdgeDirection::meridional, "meridional"), named(EdgeDirection::sagittal, "sagittal")},
      3,
      fmt::format("MTF50 over the frame, {:.3f} (dark) to {:.3f} (light) cycles/pixel", range.low,
                  range.high));
}

std::string sharpness_profile_svg(const SfrPage& page) {
  const std::vector<EdgeInFrame> edges = leading_edges(page);
  Plot plot;
  plot.title = "MTF50 over the image height";
  const double unit = page.pitch_um ? *page.pitch_um * 1e-3 : 1;
  plot.x = {"image height", page.pitch_um ? "mm" : "pixels", PlotScale::linear, 0.0};
  plot.y = {"MTF50", "cycles/pixel", PlotScale::linear, 0.0};
  double highest = 0;
  for (const EdgeInFrame& e : edges) highest = std::max(highest, e.height_px);
  constexpr int points = 49;
  std::vector<double> heights, shown;
  for (int i = 0; i < points; ++i)
    heights.push_back(highest * i / (points - 1)), shown.push_back(heights.back() * unit);
  for (const auto& [direction, name, colour, stroke] :
       {std::tuple{EdgeDirection::meridional, "meridional", "#0072b2", PlotStroke::solid},
        {EdgeDirection::sagittal, "sagittal", "#d55e00", PlotStroke::dashed}}) {
    const std::vector<EdgeInFrame> some = of_direction(edges, direction);
    if (some.empty()) continue;
    std::vector<double> x, y;
    for (const EdgeInFrame& e : some) x.push_back(e.height_px * unit), y.push_back(e.mtf50_cpp);
    plot.scatter("", x, y).colour = colour;
    PlotSeries& line = plot.line(name, shown, sharpness_over_height(some, heights));
    line.colour = colour, line.stroke = stroke;
  }
  return plot.svg();
}

std::string lateral_colour_svg(const SfrPage& page) {
  const std::vector<EdgeInFrame> edges = edges_in_frame(page.edges, page.columns, page.rows);
  Plot plot;
  plot.title = "Lateral colour";
  const double unit = page.pitch_um ? *page.pitch_um * 1e-3 : 1;
  plot.x = {"image height", page.pitch_um ? "mm" : "pixels", PlotScale::linear, 0.0};
  plot.y = {"farther out than green", "pixels"};
  for (const auto& [channel, colour] : {std::pair{"red", "#c0392b"}, {"blue", "#2456a8"}}) {
    const std::optional<LateralColour> fit = lateral_colour(edges, channel, half_diagonal(page));
    if (!fit) continue;
    std::vector<double> x, y, heights, line;
    for (const EdgeInFrame& e : edges) {
      if (e.channel != channel || !e.lateral_offset_px || e.direction != EdgeDirection::meridional) continue;
      x.push_back(e.height_px * unit), y.push_back(*e.lateral_offset_px / e.outward);
    }
    for (int i = 0; i <= 48; ++i)
      heights.push_back(half_diagonal(page) * unit * i / 48), line.push_back(fit->at(i / 48.0));
    plot.scatter("", x, y).colour = colour;
    plot.line(channel, heights, line).colour = colour;
  }
  return plot.series.empty() ? std::string() : plot.svg();
}

std::string sfr_page_html(const SfrPage& page) {
  const std::vector<EdgeInFrame> edges = leading_edges(page);
  html::Page result(page.title, "Sharpness measured on slanted edges");
  result.section("Numbers").add(summary(page, edges));
  if (!page.annotated_svg.empty())
    result.add(html::figure(html::drawing(page.annotated_svg), "The edges and their MTF50 in cycles/pixel."));
  result.section("Over the frame", "Frame")
      .add(html::figure(html::drawing(sharpness_map_svg(page)),
                        "Edges along circles about the middle measure the meridional blur, edges that point "
                        "to the middle the "
                        "sagittal one. Dots are the edges; grey: none near."))
      .add(html::figure(html::drawing(sharpness_profile_svg(page)),
                        "Edges, and lines fitted to those about each height."));
  if (const std::string colour = lateral_colour_svg(page); !colour.empty())
    result.section("Lateral colour")
        .add(html::figure(html::drawing(colour), "Meridional edges, and a · h + b · h³ fitted to all."));
  const Table table = edge_table(page);
  result.section("Curves").add(curves(page));
  result.section("Edges")
      .add(html::table(table))
      .add(html::download("edges.csv", "text/csv", to_csv(table), "data (CSV)"));
  return result.html();
}

}  // namespace petzval
