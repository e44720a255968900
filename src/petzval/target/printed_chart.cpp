// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/target/printed_chart.h>
#include <petzval/target/test_charts.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// Of the marks, over the shorter side; and how far their middles stand from the sides, over that.
constexpr double mark_share = 0.03, mark_inset = 1.7;
/// What is left free along the sides, over the radius of the marks.
constexpr double margin_in_radii = 3.2;
/// Units of test_chart() in a millimetre.
constexpr double units_per_mm = 4;

std::string path_of(const Polygon& polygon) {
  std::string path;
  for (const Contour& contour : polygon.contours) {
    for (std::size_t i = 0; i < contour.size(); ++i)
      path += fmt::format("{}{:.5g} {:.5g}", i == 0 ? "M" : "L", contour[i].x, contour[i].y);
    path += "Z";
  }
  return path;
}

/// The sRGB code (IEC 61966-2-1) of a share of the light.
int code_of(double level) {
  const double light = std::clamp(level, 0.0, 1.0);
  const double code = light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
  return static_cast<int>(std::lround(255 * code));
}

}  // namespace

std::array<ChartMark, 4> chart_marks(double width_mm, double height_mm) {
  const double radius = mark_share * std::min(width_mm, height_mm), inset = mark_inset * radius;
  std::array<ChartMark, 4> marks;
  const std::array<Vertex, 4> places{{{inset, inset},
                                      {width_mm - inset, inset},
                                      {width_mm - inset, height_mm - inset},
                                      {inset, height_mm - inset}}};
  for (std::size_t i = 0; i < marks.size(); ++i)
    marks[i] = {places[i], radius, radius * std::sqrt(ChartMark::hole_share),
                radius * std::sqrt(i == 0 ? ChartMark::first_dot_share : ChartMark::dot_share)};
  return marks;
}

TargetScene printed_chart(const std::string& name, double width_mm, double height_mm) {
  constexpr double least_mm = 60, most_mm = 5000;
  if (!(std::min(width_mm, height_mm) >= least_mm && std::max(width_mm, height_mm) <= most_mm))
    throw InputError(fmt::format("a chart of {:g} x {:g} mm: {:g} to {:g} mm a side are right", width_mm,
                                 height_mm, least_mm, most_mm));
  const std::array<ChartMark, 4> marks = chart_marks(width_mm, height_mm);
  const double margin = margin_in_radii * marks[0].radius_mm;
  const int columns = static_cast<int>((width_mm - 2 * margin) * units_per_mm),
            rows = static_cast<int>((height_mm - 2 * margin) * units_per_mm);
  TargetScene scene = test_chart(name, columns, rows);
  const double left = 0.5 * (width_mm - columns / units_per_mm),
               top = 0.5 * (height_mm - rows / units_per_mm);
  for (Polygon& polygon : scene.polygons)
    for (Contour& contour : polygon.contours)
      for (Vertex& v : contour) v = {left + v.x / units_per_mm, top + v.y / units_per_mm};
  constexpr int corners = 180;
  for (const ChartMark& mark : marks) {
    scene.polygons.push_back({{regular_polygon(mark.centre, mark.radius_mm, corners, 0),
                               regular_polygon(mark.centre, mark.hole_mm, corners, 0)},
                              0,
                              0});
    scene.polygons.push_back({{regular_polygon(mark.centre, mark.dot_mm, corners, 0)}, 0, 0});
  }
  return scene;
}

std::string printed_chart_svg(const TargetScene& scene, double width_mm, double height_mm) {
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:g}mm\" height=\"{1:g}mm\" viewBox=\"0 0 {0:g} "
      "{1:g}\">\n",
      width_mm, height_mm);
  const int ground = code_of(scene.ground);
  svg += fmt::format("<rect width=\"{:g}\" height=\"{:g}\" fill=\"#{:02x}{:02x}{:02x}\"/>\n", width_mm,
                     height_mm, ground, ground, ground);
  for (const Polygon& polygon : scene.polygons) {
    const int code = code_of(polygon.level);
    svg += fmt::format("<path fill-rule=\"evenodd\" fill=\"#{:02x}{:02x}{:02x}\" d=\"{}\"/>\n", code, code,
                       code, path_of(polygon));
  }
  return svg + "</svg>\n";
}

}  // namespace petzval
