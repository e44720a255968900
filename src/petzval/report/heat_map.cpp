// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/report/data_uri.h>
#include <petzval/report/heat_map.h>
#include <petzval/report/ticks.h>
#include <petzval/report/xml.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval {

namespace {

struct ValueRange {
  double black, white;
};

ValueRange value_range(std::span<const float> values, const HeatMapOptions& options) {
  double smallest = 0, largest = -std::numeric_limits<double>::infinity();
  for (const float value : values) {
    if (!std::isfinite(value)) continue;
    smallest = std::min<double>(smallest, value);
    largest = std::max<double>(largest, value);
  }
  return {options.black.value_or(smallest), options.white.value_or(largest)};
}

void draw_scale_bar(XmlWriter& xml, const ImageStripOptions& options, double x, double bottom) {
  const double length = nice_length(options.frame_width / 2.5);
  const double length_px = length / options.frame_width * options.frame_px;
  xml.leaf("rect",
           {{"x", x + 8}, {"y", bottom - 10}, {"width", length_px}, {"height", 2.0}, {"fill", "#fff"}});
  xml.text("text", {{"x", x + 8}, {"y", bottom - 14}, {"fill", "#fff"}, {"font-size", 10.0}},
           short_number(length) + " " + options.unit);
}

void draw_caption(XmlWriter& xml, std::string_view caption, double x_centre, double y) {
  while (!caption.empty()) {
    const std::size_t end = std::min(caption.find('\n'), caption.size());
    xml.text("text",
             {{"class", "pz-ink"}, {"x", x_centre}, {"y", y}, {"font-size", 11.0}, {"text-anchor", "middle"}},
             caption.substr(0, end));
    caption.remove_prefix(std::min(end + 1, caption.size()));
    y += 14;
  }
}

}  // namespace

std::string heat_map_png(std::span<const float> values, int columns, int rows,
                         const HeatMapOptions& options) {
  if (!(options.gamma > 0)) throw InputError("the gamma of a heat map must be positive");
  if (columns < 1 || rows < 1 ||
      static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows) != values.size())
    throw InputError("a heat map needs exactly rows times columns values");
  const ValueRange range = value_range(values, options);
  const std::array<Rgb8, 256> colours = colour_table(options.map);
  constexpr Rgb8 not_a_number{128, 128, 128};
  const std::size_t width = static_cast<std::size_t>(columns);
  std::vector<Rgb8> pixels(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t row = i / width, column = i % width;
    const std::size_t from_row = options.first_row_on_top ? row : static_cast<std::size_t>(rows) - 1 - row;
    const double value = values[from_row * width + column];
    const double share = std::clamp((value - range.black) / (range.white - range.black), 0.0, 1.0);
    const double level = std::isfinite(share) ? std::pow(share, 1 / options.gamma) : 0;
    pixels[i] =
        std::isfinite(value) ? colours[static_cast<std::size_t>(std::lround(255 * level))] : not_a_number;
  }
  return encode_png(pixels, columns, rows);
}

std::string image_strip_svg(const std::vector<StripFrame>& frames, const ImageStripOptions& options,
                            const std::string& description) {
  constexpr double gap = 10, line_height = 14;
  std::ptrdiff_t caption_lines = 0;
  for (const StripFrame& frame : frames)
    if (!frame.caption.empty())
      caption_lines =
          std::max(caption_lines, 1 + std::count(frame.caption.begin(), frame.caption.end(), '\n'));
  const std::size_t per_row = static_cast<std::size_t>(std::max(1, options.frames_per_row));
  const std::size_t rows = (frames.size() + per_row - 1) / per_row;
  const std::size_t columns = std::min(per_row, frames.size());
  const double row_height = options.frame_px + line_height * static_cast<double>(caption_lines) +
                            (caption_lines > 0 ? 1.6 : 1) * gap;

  XmlWriter xml;
  open_svg(xml, gap + static_cast<double>(columns) * (options.frame_px + gap),
           gap + static_cast<double>(rows) * row_height, description);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double x = gap + static_cast<double>(i % per_row) * (options.frame_px + gap);
    const double y = gap + static_cast<double>(i / per_row) * row_height;
    xml.leaf("image", {{"x", x},
                       {"y", y},
                       {"width", options.frame_px},
                       {"height", options.frame_px},
                       {"preserveAspectRatio", "none"},
                       {"style", "image-rendering:pixelated"},
                       {"href", data_uri("image/png", frames[i].png)}});
    if (i == 0 && options.frame_width > 0) draw_scale_bar(xml, options, x, y + options.frame_px);
    draw_caption(xml, frames[i].caption, x + options.frame_px / 2, y + options.frame_px + line_height);
  }
  return std::move(xml).finish();
}

}  // namespace petzval
