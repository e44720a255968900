// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/colour/display.h>
#include <petzval/report/colours.h>
#include <petzval/report/data_uri.h>
#include <petzval/report/heat_map.h>
#include <petzval/report/psf_drawing.h>
#include <petzval/report/ticks.h>
#include <petzval/report/xml.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace petzval {

namespace {

constexpr double drawn_share = 0.99;

/// Light per area at a point of the window, between samples linearly; none outside.
double light_at(const Psf& psf, double s_um, double t_um) {
  const double column = s_um / psf.spacing_um + psf.size / 2, row = t_um / psf.spacing_um + psf.size / 2;
  const double left = std::floor(column), below = std::floor(row);
  double sum = 0;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      const double x = left + j, y = below + i;
      if (x < 0 || y < 0 || x >= psf.size || y >= psf.size) continue;
      sum += (1 - std::abs(column - x)) * (1 - std::abs(row - y)) *
             static_cast<double>(psf.at(static_cast<int>(y), static_cast<int>(x)));
    }
  return sum / (psf.spacing_um * psf.spacing_um);
}

std::array<double, 3> linear_colour(double wavelength_nm) {
  const Rgb8 colour = wavelength_colour(wavelength_nm);
  return {srgb_decoded(colour.r / 255.0), srgb_decoded(colour.g / 255.0), srgb_decoded(colour.b / 255.0)};
}

/// A picture of one place, its middle the place: linear light.
std::vector<std::array<double, 3>> place_picture(const PsfPlace& place, int side, double half_um) {
  std::vector<std::array<double, 3>> pixels(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  const double radius = std::hypot(place.x_mm, place.y_mm);
  const double out_x = radius > 0 ? place.x_mm / radius : 0, out_y = radius > 0 ? place.y_mm / radius : 1;
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      const double x = ((column + 0.5) / side * 2 - 1) * half_um, y = (1 - (row + 0.5) / side * 2) * half_um;
      const double t = x * out_x + y * out_y, s = x * out_y - y * out_x;
      auto& pixel = pixels[static_cast<std::size_t>(row * side + column)];
      for (const MappedPsf& each : place.light) {
        const double light = light_at(each.psf, s, t - each.above_um);
        const std::array<double, 3> colour = linear_colour(each.wavelength_nm);
        for (std::size_t k = 0; k < 3; ++k) pixel[k] += light * colour[k];
      }
    }
  return pixels;
}

std::string place_png(const PsfPlace& place, int side, double half_um) {
  const auto pixels = place_picture(place, side, half_um);
  double peak = 0;
  for (const auto& pixel : pixels) peak = std::max({peak, pixel[0], pixel[1], pixel[2]});
  std::vector<Rgb8> colours;
  for (const auto& pixel : pixels) {
    const auto code = [&](double value) {
      return quantised_8(std::sqrt(std::max(value, 0.0) / std::max(peak, 1e-300)));
    };
    colours.push_back({code(pixel[0]), code(pixel[1]), code(pixel[2])});
  }
  return encode_png(colours, side, side);
}

}  // namespace

double half_width_holding_um(const Psf& psf, double share) {
  const int middle = psf.size / 2;
  double total = 0;
  for (const float value : psf.values) total += value;
  // Rings of squares, from the inside.
  std::vector<double> rings(static_cast<std::size_t>(psf.size - middle) + 1 +
                            static_cast<std::size_t>(middle));
  for (int i = 0; i < psf.size; ++i)
    for (int j = 0; j < psf.size; ++j)
      rings[static_cast<std::size_t>(std::max(std::abs(i - middle), std::abs(j - middle)))] += psf.at(i, j);
  double sum = 0;
  for (std::size_t ring = 0; ring < rings.size(); ++ring)
    if ((sum += rings[ring]) >= share * total) return (static_cast<double>(ring) + 0.5) * psf.spacing_um;
  return psf.half_width_um();
}

std::string psf_strip_svg(const std::vector<DrawnPsf>& psfs, int per_row) {
  if (psfs.empty()) throw InputError("a drawing of PSFs needs a PSF");
  double half_um = 0;
  for (const DrawnPsf& each : psfs) half_um = std::max(half_um, half_width_holding_um(each.psf, drawn_share));
  constexpr int side = 120;
  std::vector<StripFrame> frames;
  for (const DrawnPsf& each : psfs) {
    std::vector<float> values;
    for (int row = 0; row < side; ++row)
      for (int column = 0; column < side; ++column)
        values.push_back(static_cast<float>(light_at(each.psf, ((column + 0.5) / side * 2 - 1) * half_um,
                                                     (1 - (row + 0.5) / side * 2) * half_um)));
    HeatMapOptions map;
    map.gamma = 2;
    frames.push_back({heat_map_png(values, side, side, map), each.caption});
  }
  ImageStripOptions strip;
  strip.frame_px = 160;
  strip.frames_per_row = per_row;
  strip.frame_width = 2 * half_um;
  strip.unit = "µm";
  return image_strip_svg(frames, strip, "Point-spread functions on one scale, square root of the light");
}

std::vector<PsfPlace> even_places(double width_mm, double height_mm, int across) {
  const double cell_mm = width_mm / across;
  const int down = std::max(1, static_cast<int>(std::lround(height_mm / cell_mm)));
  std::vector<PsfPlace> places;
  for (int row = 0; row < down; ++row)
    for (int column = 0; column < across; ++column)
      places.push_back({(column - 0.5 * (across - 1)) * cell_mm, (0.5 * (down - 1) - row) * cell_mm, {}});
  return places;
}

std::string psf_map_svg(const std::vector<PsfPlace>& places, int across, double frame_width_mm,
                        const std::string& title) {
  double half_um = 0;
  for (const PsfPlace& place : places)
    for (const MappedPsf& each : place.light)
      half_um = std::max(half_um, half_width_holding_um(each.psf, drawn_share) + std::abs(each.above_um));
  if (!(half_um > 0)) throw InputError("a map of PSFs needs places and their light");
  constexpr double width_px = 900, margin = 10, title_px = 22;
  constexpr int side = 128;
  const double cell_px = width_px / across;
  const auto rows = static_cast<double>(places.size()) / across;
  XmlWriter xml;
  open_svg(xml, width_px + 2 * margin, rows * cell_px + 2 * margin + 2 * title_px, title);
  xml.text("text", {{"class", "pz-ink"}, {"x", margin}, {"y", title_px}, {"font-size", 14.0}}, title);
  xml.leaf("rect", {{"x", margin},
                    {"y", margin + title_px},
                    {"width", width_px},
                    {"height", rows * cell_px},
                    {"fill", "#000"}});
  for (std::size_t i = 0; i < places.size(); ++i)
    xml.leaf("image",
             {{"x", margin + cell_px * static_cast<double>(i % static_cast<std::size_t>(across))},
              {"y", margin + title_px + cell_px * static_cast<double>(i / static_cast<std::size_t>(across))},
              {"width", cell_px},
              {"height", cell_px},
              {"href", data_uri("image/png", place_png(places[i], side, half_um))}});
  const double bar_um = nice_length(half_um), bar_px = bar_um / (2 * half_um) * cell_px,
               bottom = margin + title_px + rows * cell_px + title_px;
  xml.leaf("rect",
           {{"class", "pz-ink"}, {"x", margin}, {"y", bottom - 5}, {"width", bar_px}, {"height", 3.0}});
  xml.text(
      "text", {{"class", "pz-ink"}, {"x", margin + bar_px + 8}, {"y", bottom}, {"font-size", 12.0}},
      fmt::format("{} µm; every star enlarged {:.3g} times about its place in a frame {:.3g} mm wide",
                  short_number(bar_um), frame_width_mm / across / (2 * half_um * mm_per_um), frame_width_mm));
  return std::move(xml).finish();
}

}  // namespace petzval
