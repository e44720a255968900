// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/report/colours.h>
#include <petzval/report/plot_layout.h>
#include <petzval/report/xml.h>

#include <algorithm>
#include <limits>

namespace petzval {

namespace {

constexpr double right_margin_px = 22, bottom_margin_px = 50, least_frame_px = 60;
constexpr double title_px = 26, legend_gap_px = 18;

/// The width that a text at 12 px is given; the font is not known here.
double text_width_px(std::string_view text) {
  return 7.0 * static_cast<double>(character_count(text));
}

/// The extent of the data along one axis, grown one value at a time.
class Extent {
 public:
  explicit Extent(PlotScale scale) : scale_(scale) {}
  void include(double value) {
    if (!PlotLayout::drawable(scale_, value)) return;
    low_ = std::min(low_, value);
    high_ = std::max(high_, value);
  }
  double low() const { return low_ <= high_ ? low_ : scale_ == PlotScale::linear ? 0 : 1; }
  double high() const { return low_ <= high_ ? high_ : scale_ == PlotScale::linear ? 1 : 10; }

 private:
  PlotScale scale_;
  double low_ = std::numeric_limits<double>::infinity(), high_ = -std::numeric_limits<double>::infinity();
};

struct Extents {
  Extent x, y;
};

Extents data_extents(const Plot& plot, const PlotLayout& layout) {
  Extents extents{Extent(plot.x.scale), Extent(plot.y.scale)};
  for (const PlotSeries& series : plot.series) {
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      if (!layout.drawable(series.x[i], series.y[i])) continue;
      extents.x.include(series.x[i]);
      extents.y.include(series.y[i]);
    }
  }
  for (const PlotImage& image : plot.images) {
    for (const double x : {image.left, image.right}) extents.x.include(x);
    for (const double y : {image.bottom, image.top}) extents.y.include(y);
  }
  for (const PlotGuide& guide : plot.guides)
    (guide.at == PlotGuide::At::x ? extents.x : extents.y).include(guide.value);
  return extents;
}

/// Ticks of one axis: ends that the user gave are kept, free ends grow to a tick.
Ticks axis_ticks(const PlotAxis& axis, const Extent& extent, double length_px, double px_per_tick) {
  const int wanted = static_cast<int>(std::clamp(length_px / px_per_tick, 2.0, 50.0));
  const double low = axis.from.value_or(extent.low()), high = axis.to.value_or(extent.high());
  const Ticks grown = make_ticks(axis.scale, low, high, wanted, true);
  if (!axis.from && !axis.to) return grown;
  return make_ticks(axis.scale, axis.from.value_or(grown.from), axis.to.value_or(grown.to), wanted, false);
}

std::vector<std::string> series_colours(const Plot& plot) {
  std::vector<std::string> colours;
  std::size_t free_ones = 0;
  for (const PlotSeries& series : plot.series)
    colours.push_back(series.colour.empty() ? series_colour(free_ones++).hex() : series.colour);
  return colours;
}

/// Entries flow in rows above the frame, where they cannot hide data.
std::vector<LegendEntry> flow_legend(const Plot& plot, double left, double right) {
  std::vector<LegendEntry> legend;
  double x = left, row = 0;
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    if (plot.series[i].label.empty()) continue;
    const double width = legend_key_px + text_width_px(plot.series[i].label) + legend_gap_px;
    if (x > left && x + width > right + legend_gap_px) {
      x = left;
      ++row;
    }
    legend.push_back({i, x, row});
    x += width;
  }
  return legend;
}

/// The frame keeps its width, unless it would become taller than `tallest` times that.
void equalise_aspect(PlotLayout& layout) {
  constexpr double tallest = 1.5;
  const double ratio = (layout.y.to - layout.y.from) / (layout.x.to - layout.x.from);
  if (!std::isfinite(ratio) || ratio <= 0) return;
  layout.height = std::max(layout.width * ratio, 1.0);
  const double limit = tallest * layout.width;
  if (layout.height > limit) {
    layout.width = std::max(layout.width * limit / layout.height, 1.0);
    layout.height = limit;
  }
}

}  // namespace

PlotLayout lay_out(const Plot& plot) {
  for (const PlotSeries& series : plot.series)
    if (series.x.size() != series.y.size())
      throw InputError(fmt::format("series '{}' of a plot has {} x values and {} y values", series.label,
                                   series.x.size(), series.y.size()));
  PlotLayout layout;
  layout.x_scale = plot.x.scale;
  layout.y_scale = plot.y.scale;
  layout.colours = series_colours(plot);
  const Extents extents = data_extents(plot, layout);

  // The labels of the y axis decide where the frame begins, its width decides on the ticks of the x axis.
  constexpr double px_per_x_tick = 78, px_per_y_tick = 46;
  layout.y = axis_ticks(plot.y, extents.y, plot.height_px - bottom_margin_px, px_per_y_tick);
  double widest_label = 0;
  for (const std::string& label : layout.y.labels)
    widest_label = std::max(widest_label, text_width_px(label));
  layout.left = (plot.y.label.empty() && plot.y.unit.empty() ? 18 : 38) + widest_label;
  layout.width = std::max(plot.width_px - layout.left - right_margin_px, least_frame_px);
  layout.x = axis_ticks(plot.x, extents.x, layout.width, px_per_x_tick);

  layout.legend = flow_legend(plot, layout.left, layout.left + layout.width);
  layout.top = 14 + (plot.title.empty() ? 0 : title_px);
  if (!layout.legend.empty()) layout.top += legend_row_px * (layout.legend.back().row + 1) + 2;
  layout.height = std::max(plot.height_px - layout.top - bottom_margin_px, least_frame_px);
  if (plot.equal_aspect) equalise_aspect(layout);
  layout.total_width = layout.left + layout.width + right_margin_px;
  layout.total_height = layout.top + layout.height + bottom_margin_px;
  return layout;
}

}  // namespace petzval
