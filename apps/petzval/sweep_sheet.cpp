// SPDX-License-Identifier: BSD-3-Clause
#include "sweep_sheet.h"

#include <petzval/colour/display.h>
#include <petzval/image/formats/png.h>
#include <petzval/scene/lettering.h>

#include <algorithm>
#include <cmath>

namespace petzval::app {

namespace {

constexpr int thumbnail = 320, gap = 12, label_height = 12, label_room = 24;
constexpr std::uint16_t paper = 245, ink = 30, shade = 225;

/// An 8-bit RGB canvas.
struct Canvas {
  PngImage image;
  Canvas(int columns, int rows) {
    image.columns = columns;
    image.rows = rows;
    image.samples.assign(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows) * 3, paper);
  }
  std::uint16_t* at(int column, int row) {
    return &image.samples[(static_cast<std::size_t>(row) * static_cast<std::size_t>(image.columns) +
                           static_cast<std::size_t>(column)) *
                          3];
  }
};

/// The scale at which a picture fits a thumbnail: a whole number for small ones, whose pixels become squares.
double fitting_scale(const PngImage& picture) {
  const double scale = double(thumbnail) / std::max(picture.columns, picture.rows);
  return scale > 1 ? std::floor(scale) : scale;
}

/// Draws a picture, each pixel the mean of those that fall on it: of one, where it is enlarged.
void draw(Canvas& canvas, const PngImage& picture, int left, int top) {
  const double scale = fitting_scale(picture);
  const int columns = std::max(1, static_cast<int>(std::lround(picture.columns * scale))),
            rows = std::max(1, static_cast<int>(std::lround(picture.rows * scale)));
  const int shift = picture.bits == 16 ? 8 : 0, channels = picture.channels;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const int x0 = column * picture.columns / columns, y0 = row * picture.rows / rows;
      const int x1 = std::max(x0 + 1, (column + 1) * picture.columns / columns),
                y1 = std::max(y0 + 1, (row + 1) * picture.rows / rows);
      unsigned sums[3] = {};
      for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x)
          for (int c = 0; c < 3; ++c)
            sums[c] += static_cast<unsigned>(
                picture.samples[(static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.columns) +
                                 static_cast<std::size_t>(x)) *
                                    static_cast<std::size_t>(channels) +
                                static_cast<std::size_t>(channels < 3 ? 0 : c)] >>
                shift);
      for (int c = 0; c < 3; ++c)
        canvas.at(left + column, top + row)[c] =
            static_cast<std::uint16_t>(sums[c] / static_cast<unsigned>((x1 - x0) * (y1 - y0)));
    }
}

/// The height at which a text fits below a thumbnail.
double fitting_height(const std::string& text) {
  return std::min<double>(label_height, label_height * thumbnail / text_width(text, label_height));
}

void write_label(Canvas& canvas, const std::string& text, int left, int top, double height) {
  Shape letters;
  add_text(letters, text, left, top, height);
  std::vector<double> coverage(static_cast<std::size_t>(canvas.image.columns));
  const int bottom = top + static_cast<int>(std::ceil(label_height + text_descent(label_height)));
  for (int row = top - 1; row <= bottom; ++row) {
    letters.coverage(row, coverage);
    for (int column = 0; column < canvas.image.columns; ++column)
      for (int c = 0; c < 3; ++c) {
        std::uint16_t& sample = canvas.at(column, row)[c];
        const double share = coverage[static_cast<std::size_t>(column)];
        sample = static_cast<std::uint16_t>(std::lround(sample + share * (double(ink) - sample)));
      }
  }
}

/// A cell without a picture.
void draw_failure(Canvas& canvas, int left, int top, int rows) {
  for (int row = top; row < top + rows; ++row)
    for (int column = left; column < left + thumbnail; ++column)
      for (int c = 0; c < 3; ++c) canvas.at(column, row)[c] = shade;
  const int inset = std::min(gap, rows - label_height);
  write_label(canvas, "failed", left + gap, top + std::max(0, inset), label_height);
}

/// How many thumbnails stand in a row, so that the sheet is about as wide as tall.
int squarest_row(int count, int unit, int cell_columns, int cell_rows) {
  constexpr double shape = 4.0 / 3;  // rather a little wide than tall
  const auto skew = [&](int per_row) {
    const int rows = (count + per_row - 1) / per_row;
    return std::abs(std::log(double(per_row * cell_columns) / double(rows * cell_rows) / shape));
  };
  constexpr double strip = 1.4;  // a sheet of more than four times its other side
  int best = 1, best_of_units = unit;
  for (int per_row = 1; per_row <= count; ++per_row) {
    if (skew(per_row) < skew(best)) best = per_row;
    if (per_row % unit == 0 && skew(per_row) < skew(best_of_units)) best_of_units = per_row;
  }
  return skew(best_of_units) <= strip ? best_of_units : best;
}

/// The value of which one in two hundred of all pixels' brightest colours is above, 0 to 1.
double bright_value(const std::vector<PngImage>& pictures) {
  std::vector<std::size_t> counts(256);
  std::size_t pixels = 0;
  for (const PngImage& picture : pictures) {
    const int colours = std::min(picture.channels, 3), shift = picture.bits == 16 ? 8 : 0;
    for (std::size_t at = 0; at < picture.samples.size(); at += static_cast<std::size_t>(picture.channels)) {
      const auto first = picture.samples.begin() + static_cast<std::ptrdiff_t>(at);
      ++counts[static_cast<std::size_t>(*std::max_element(first, first + colours) >> shift)];
      ++pixels;
    }
  }
  std::size_t above = 0;
  for (std::size_t value = counts.size(); value-- > 1;)
    if ((above += counts[value]) * 200 >= pixels) return static_cast<double>(value) / 255;
  return 1;  // nothing to be seen at any brightness
}

/// The canvas's values that show `factor` times the light of pictures' values.
void brighten(PngImage& picture, double factor) {
  const double most = picture.bits == 16 ? 65535 : 255;
  for (std::uint16_t& sample : picture.samples)
    sample = static_cast<std::uint16_t>(
        std::lround(most * srgb_encoded(std::min(1.0, factor * srgb_decoded(sample / most)))));
}

}  // namespace

double write_contact_sheet(const std::string& path, const std::vector<SheetEntry>& entries, int unit) {
  std::vector<PngImage> pictures(entries.size());
  int tallest = label_height;
  double height = label_height;  // of all labels
  for (std::size_t i = 0; i < entries.size(); ++i) {
    height = std::min(height, fitting_height(entries[i].label));
    if (entries[i].picture.empty()) continue;
    pictures[i] = read_png(entries[i].picture);
    tallest = std::max(tallest, static_cast<int>(std::lround(pictures[i].rows * fitting_scale(pictures[i]))));
  }
  constexpr double dark = 0.5;  // a value of sRGB
  const double bright = bright_value(pictures);
  const double factor = bright < dark ? srgb_decoded(0.95) / srgb_decoded(bright) : 1;
  const int count = static_cast<int>(entries.size());
  const int per_row = squarest_row(count, unit, thumbnail + gap, tallest + label_room + gap);
  const int columns = std::min(per_row, count), rows = (count + per_row - 1) / per_row;
  Canvas canvas(gap + columns * (thumbnail + gap), gap + rows * (tallest + label_room + gap));
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const int left = gap + static_cast<int>(i) % per_row * (thumbnail + gap),
              top = gap + static_cast<int>(i) / per_row * (tallest + label_room + gap);
    if (factor > 1) brighten(pictures[i], factor);
    if (entries[i].picture.empty())
      draw_failure(canvas, left, top, tallest);
    else
      draw(canvas, pictures[i], left, top);
    write_label(canvas, entries[i].label, left, top + tallest + 6, height);
  }
  write_png(path, canvas.image);
  return factor;
}

}  // namespace petzval::app
