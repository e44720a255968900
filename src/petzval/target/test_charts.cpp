// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/scene/named_chart.h>
#include <petzval/target/stroke_font.h>
#include <petzval/target/test_charts.h>
#include <petzval/target/visible_regions.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

struct Frame {
  double width, height;
  Vertex centre() const { return {0.5 * width, 0.5 * height}; }
  double side() const { return std::min(width, height); }
};

void add(TargetScene& scene, Contour contour) {
  scene.polygons.push_back({{std::move(contour)}, 0, 0});
}

Vertex polar(Vertex centre, double radius, double angle) {
  return {centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)};
}

TargetScene slanted_edges(const Frame& frame) {
  TargetScene scene;
  const double pitch = frame.side() / 3, side = 0.55 * pitch;
  const int across = static_cast<int>(frame.width / pitch + 1e-9),
            down = static_cast<int>(frame.height / pitch + 1e-9);
  for (int row = 0; row < down; ++row)
    for (int column = 0; column < across; ++column)
      add(scene, rectangle({frame.width / 2 + (column - 0.5 * (across - 1)) * pitch,
                            frame.height / 2 + (row - 0.5 * (down - 1)) * pitch},
                           side, side, 5));
  return scene;
}

/// Corners of an arc that stays within 1e-4 pixels of its chords.
int arc_pieces(double radius, double angle) {
  return std::max(1, static_cast<int>(std::ceil(std::abs(angle) * std::sqrt(radius / (8 * 1e-4)))));
}

TargetScene sectors(const Frame& frame, int count, double first_deg) {
  TargetScene scene;
  const double radius = 0.45 * frame.side(), width = pi / count;
  // The tips stay apart, so that no two sectors touch.
  const double inner = std::max(1.0, 0.02 * radius);
  for (int i = 0; i < count; ++i) {
    const double from = first_deg * pi / 180 + 2 * width * i;
    const int outer_pieces = arc_pieces(radius, width), inner_pieces = arc_pieces(inner, width);
    Contour contour;
    for (int j = 0; j <= outer_pieces; ++j)
      contour.push_back(polar(frame.centre(), radius, from + width * j / outer_pieces));
    for (int j = inner_pieces; j >= 0; --j)
      contour.push_back(polar(frame.centre(), inner, from + width * j / inner_pieces));
    add(scene, std::move(contour));
  }
  return scene;
}

TargetScene checkerboard(const Frame& frame) {
  TargetScene scene;
  constexpr int fields = 8;
  const double side = 0.8 * frame.side() / fields, c = std::cos(5 * pi / 180), s = std::sin(5 * pi / 180);
  for (int row = 0; row < fields; ++row)
    for (int column = row % 2; column < fields; column += 2) {
      const double u = (column - 0.5 * (fields - 1)) * side, v = (row - 0.5 * (fields - 1)) * side;
      add(scene,
          rectangle({frame.centre().x + u * c - v * s, frame.centre().y + u * s + v * c}, side, side, 5));
    }
  return scene;
}

TargetScene pinch(const Frame& frame) {
  TargetScene scene;
  constexpr int bars = 9;
  const double top = 0.08 * frame.height, bottom = 0.92 * frame.height;
  const double wide = std::min(8.0, frame.width / (2.5 * bars)), narrow = 0.9;
  for (int i = 0; i < bars; ++i) {
    const double place = 2 * (i - bars / 2);
    const auto x = [&](double half_bars, double width) { return frame.centre().x + half_bars * width; };
    add(scene, {{x(place - 0.5, wide), top},
                {x(place + 0.5, wide), top},
                {x(place + 0.5, narrow), bottom},
                {x(place - 0.5, narrow), bottom}});
  }
  return scene;
}

/// Nine bars whose frequency grows evenly from 0.05 to 0.55 cycles/pixel on the way down: as the hyperbolic
/// wedges of ISO 12233.
TargetScene trumpet(const Frame& frame) {
  TargetScene scene;
  constexpr int bars = 9;
  constexpr double lowest = 0.05, highest = 0.55;
  const double top = 0.08 * frame.height, bottom = 0.92 * frame.height;
  const double first = std::max(lowest, bars / (0.9 * frame.width));
  // A bar's edge is half_bars/(2f): its bend, the second derivative, is half_bars (slope of f)²/f³.
  const double slope = (highest - first) / (bottom - top);
  const double bend = bars * slope * slope / (first * first * first);
  const int pieces = 1 + static_cast<int>((bottom - top) * std::sqrt(bend / (8 * 1e-4)));
  for (int i = 0; i < bars; ++i) {
    const double place = 2 * (i - bars / 2);
    Contour contour;
    const auto side = [&](double half_bars, int from, int to, int step) {
      for (int j = from; j != to; j += step) {
        const double share = static_cast<double>(j) / pieces;
        contour.push_back({frame.centre().x + half_bars / (2 * (first + (highest - first) * share)),
                           top + (bottom - top) * share});
      }
    };
    side(place + 0.5, 0, pieces + 1, 1);
    side(place - 0.5, pieces, -1, -1);
    add(scene, std::move(contour));
  }
  return scene;
}

/// Lines of writing, each three quarters as high as the one above it, that say how high their capitals are.
TargetScene text_lines_chart(const Frame& frame) {
  constexpr double ratio = 0.8, smallest_px = 3, tilt_deg = 2;
  constexpr double used = 0.86;        // of the picture
  constexpr double least_pitch = 1.6;  // of the capitals' height
  const auto text_at = [](double height) { return fmt::format("{:.1f} Petzval 1840", height); };
  const double largest = std::min(used * frame.width / text_width(text_at(99.9), {1, 0, 0}),
                                  used * frame.height * (1 - ratio) / least_pitch);
  std::vector<double> heights;
  double sum = 0;
  for (double height = largest; height >= smallest_px; height *= ratio) {
    heights.push_back(height);
    sum += height;
  }
  TargetScene scene;
  const double pitch = used * frame.height / sum;
  double y = 0.5 * (1 - used) * frame.height;
  for (const double height : heights) {
    const TextStyle style{height, tilt_deg, 0};
    const std::string text = text_at(height);
    const std::vector<Polygon> line =
        text_polygons(text, {0.5 * (frame.width - text_width(text, style)), y}, style);
    scene.polygons.insert(scene.polygons.end(), line.begin(), line.end());
    y += pitch * height;
  }
  return scene;
}

TargetScene zone_plate(const Frame& frame) {
  // The phase is π r²/(2R): its frequency r/(2R) is 0.5 cycles/pixel at the rim R. Dark where the cosine is
  // negative.
  TargetScene scene;
  const double rim = 0.45 * frame.side();
  const auto radius_at = [&](double half_turns) { return std::sqrt(2 * rim * half_turns); };
  for (int ring = 0;; ++ring) {
    const double inner = radius_at(2 * ring + 0.5), outer = radius_at(2 * ring + 1.5);
    if (outer > rim) break;
    const auto circle = [&](double radius) {
      return regular_polygon(frame.centre(), radius, std::max(12, arc_pieces(radius, 2 * pi)), 0);
    };
    scene.polygons.push_back({{circle(outer), circle(inner)}, 0, 0});
  }
  return scene;
}

}  // namespace

namespace {

/// The polygons of a chart that scenes have too, as far as they are within the frame.
TargetScene of_figures(const FigureChart& chart, const Frame& frame) {
  TargetScene scene;
  scene.ground = chart.ground;
  for (const ChartFigure& figure : chart.figures)
    for (const std::vector<Point>& outline : figure.outlines) {
      Contour contour;
      for (const Point& corner : outline) contour.push_back({corner.x, corner.y});
      contour = clip_to_box(contour, {0, 0}, {frame.width, frame.height});
      if (!contour.empty()) scene.polygons.push_back({{std::move(contour)}, figure.level, 0});
    }
  return scene;
}

}  // namespace

std::vector<std::string> test_chart_names() {
  std::vector<std::string> names = {"checkerboard", "pinch",   "slanted-edges", "slanted-star",
                                    "text",         "trumpet", "zone-plate"};
  for (const NamedChart& chart : named_charts())
    if (chart.figures) names.emplace_back(chart.name);
  std::sort(names.begin(), names.end());
  return names;
}

TargetScene test_chart(const std::string& name, int columns, int rows) {
  constexpr int least = 64;
  if (columns < least || rows < least)
    throw InputError(
        fmt::format("a chart of {} x {} pixels: at least {} a side are right", columns, rows, least));
  const Frame frame{static_cast<double>(columns), static_cast<double>(rows)};
  if (name == "slanted-edges") return slanted_edges(frame);
  if (name == "slanted-star") return sectors(frame, 12, 3);
  if (name == "checkerboard") return checkerboard(frame);
  if (name == "pinch") return pinch(frame);
  if (name == "trumpet") return trumpet(frame);
  if (name == "text") return text_lines_chart(frame);
  if (name == "zone-plate") return zone_plate(frame);
  if (const NamedChart* chart = find_chart(name); chart && chart->figures)
    return of_figures(chart->figures({frame.width, frame.height}, chart_parameter(name, *chart)), frame);
  throw InputError(fmt::format("no chart '{}'; the nearest are {}", name,
                               fmt::join(nearest_names(name, test_chart_names()), ", ")));
}

}  // namespace petzval
