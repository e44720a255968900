// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/scene/chart_figures.h>
#include <petzval/scene/lettering.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

namespace petzval {

namespace {

/// The parameter as a whole number within a range.
int whole_of(const ChartParameter& parameter, const char* chart, int usual, int least, int most) {
  if (parameter.text.empty()) return usual;
  const double value = parameter.number.value_or(least - 1.0);
  if (!(value >= least && value <= most) || value != std::floor(value))
    throw InputError(fmt::format("scene {}:{}: a whole number from {} to {} would be right", chart,
                                 parameter.text, least, most));
  return static_cast<int>(value);
}

std::vector<Point> box(double left, double top, double right, double bottom) {
  return {{left, top}, {right, top}, {right, bottom}, {left, bottom}};
}

std::vector<Point> turned_square(Point centre, double side, double angle_deg) {
  const double c = 0.5 * side * std::cos(radians(angle_deg)), s = 0.5 * side * std::sin(radians(angle_deg));
  std::vector<Point> corners;
  for (const auto& [u, v] : std::array<std::pair<int, int>, 4>{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}})
    corners.push_back({centre.x + u * c - v * s, centre.y + u * s + v * c});
  return corners;
}

/// Pieces of an arc that its chords follow within 1e-4.
int chords_of_arc(double radius, double angle) {
  return std::max(1, static_cast<int>(std::ceil(std::abs(angle) * std::sqrt(radius / (8 * 1e-4)))));
}

}  // namespace

FigureChart siemens_figures(ChartFrame frame, const ChartParameter& parameter) {
  const int sectors = whole_of(parameter, "siemens", 36, 2, 720);
  const Point middle = frame.centre();
  const double radius = 0.45 * frame.side(), width = pi / sectors;
  // The tips stay apart, so that no two sectors touch.
  const double inner = std::max(1.0, 0.02 * radius);
  FigureChart chart;
  ChartFigure& star = chart.figures.emplace_back();
  for (int i = 0; i < sectors; ++i) {
    std::vector<Point>& outline = star.outlines.emplace_back();
    const auto arc = [&](double r, double from, double angle) {
      const int pieces = chords_of_arc(r, angle);
      for (int j = 0; j <= pieces; ++j) {
        const double at = from + angle * j / pieces;
        outline.push_back({middle.x + r * std::cos(at), middle.y + r * std::sin(at)});
      }
    };
    arc(radius, 2 * width * i, width);
    arc(inner, 2 * width * i + width, -width);
  }
  return chart;
}

namespace {

constexpr int elements_of_group = 6;
constexpr double bars_long = 5;  // a bar's length over its width: MIL-STD-150A

double element_width(double first, int element) {
  return first * std::pow(2.0, -element / 6.0);
}

/// Three upright bars and three level ones beside them; w is the width of a bar.
void add_element(ChartFigure& dark, Point corner, double w) {
  for (int i = 0; i < 3; ++i) {
    dark.outlines.push_back(
        box(corner.x + 2 * i * w, corner.y, corner.x + (2 * i + 1) * w, corner.y + bars_long * w));
    dark.outlines.push_back(box(corner.x + 7 * w, corner.y + 2 * i * w, corner.x + (7 + bars_long) * w,
                                corner.y + (2 * i + 1) * w));
  }
}

}  // namespace

FigureChart usaf_figures(ChartFrame frame, const ChartParameter& parameter) {
  const int first_group = whole_of(parameter, "usaf1951", -2, -6, 9);
  // In widths of the first bar the chart is 48 × 36.
  constexpr double wide = 48, high = 36, finest_px = 1.0 / 3, finest_text_px = 3;
  const double first = std::min(frame.width / wide, frame.height / high);
  FigureChart chart;
  ChartFigure& dark = chart.figures.emplace_back();
  const Point corner{frame.centre().x - 0.5 * wide * first, frame.centre().y - 0.5 * high * first};
  double left = corner.x + 6 * first;
  for (int group = 0; element_width(first * std::pow(0.5, group), 0) >= finest_px; ++group) {
    const double w0 = first * std::pow(0.5, group);
    const auto write = [&](int number, double x, double y, double height) {
      if (height >= finest_text_px) add_text(dark.outlines, std::to_string(number), x, y, height);
    };
    write(first_group + group, left + 8 * w0, corner.y + 0.8 * first, 1.6 * w0);
    double top = corner.y + (group == 0 ? 3.2 : 1.2 + 2 * w0 / first) * first;
    for (int element = 0; element < elements_of_group; ++element) {
      const double w = element_width(w0, element);
      write(element + 1, left, top + 1.2 * w, 2.6 * w);
      add_element(dark, {left + 3 * w0, top}, w);
      top += 7 * w;
    }
    left += 18 * w0;
  }
  if (dark.outlines.empty())
    throw InputError("usaf1951 shows nothing at this size; more samples would be right");
  return chart;
}

namespace {

/// Dark bars along an axis, whose frequency grows evenly from `from` to `to` [1/pixel] over a length.
/// \param place  of a point that lies so far along the wedge and so far beside its axis.
void add_wedge(ChartFigure& dark, double length, double from, double to,
               const std::function<Point(double along, double beside)>& place) {
  constexpr int bars = 9;
  // A bar's edge is half_bars/(2f): its bend, the second derivative, is half_bars (slope of f)²/f³.
  const double slope = (to - from) / length, bend = bars * slope * slope / (from * from * from);
  const int pieces = 1 + static_cast<int>(length * std::sqrt(bend / (8 * 1e-3)));
  for (int i = 0; i < bars; ++i) {
    const double half_bars = 2.0 * (i - bars / 2);
    std::vector<Point>& outline = dark.outlines.emplace_back();
    const auto edge_point = [&](double halves, int j) {
      const double share = static_cast<double>(j) / pieces;
      return place(length * share, halves / (2 * (from + (to - from) * share)));
    };
    for (int j = 0; j <= pieces; ++j) outline.push_back(edge_point(half_bars + 0.5, j));
    for (int j = pieces; j >= 0; --j) outline.push_back(edge_point(half_bars - 0.5, j));
  }
}

/// The layout of the ISO 12233 chart in units of a picture of 24 × 18, origin in its middle.
class Iso12233 {
 public:
  Iso12233(ChartFrame frame, double most_lw_ph)
      : frame_(frame), unit_(std::min(frame.width / 24, frame.height / 18)) {
    // A wedge has 17 line widths, and room for 3.2 units.
    first_ = std::max({100.0, most_lw_ph / 10, 17 * frame.height / (3.2 * unit_)});
    most_ = std::max(most_lw_ph, 2 * first_);
  }

  FigureChart draw() {
    constexpr double side = 3.2, turn_deg = 5;
    const auto square = [&](double x, double y) {
      squares_.outlines.push_back(turned_square(at(x, y), side * unit_, turn_deg));
    };
    square(0, 0);
    for (const double x : {-9.4, 9.4})
      for (const double y : {-6.4, 0.0, 6.4}) square(x, y);
    for (const double sign : {-1.0, 1.0}) {
      upright_wedge({4.7 * sign, 0});
      level_wedge({0, 6.4 * sign});
    }
    return {light, {squares_, dark_}};
  }

 private:
  static constexpr double light = 0.8, length = 8, text_height = 0.42;

  Point at(double x, double y) const {
    return {frame_.centre().x + unit_ * x, frame_.centre().y + unit_ * y};
  }
  /// Line widths per picture height as cycles a sample.
  double frequency(double lw_ph) const { return lw_ph / (2 * frame_.height); }
  /// Half the width of a wedge at a share of its length [units].
  double half_width(double share) const {
    return 8.5 / (2 * frequency(first_ + (most_ - first_) * share)) / unit_;
  }
  void upright_wedge(Point middle);
  void level_wedge(Point middle);
  void write(double share, double x, double y);

  ChartFrame frame_;
  double unit_, first_, most_;
  ChartFigure squares_{{}, light / 4}, dark_{{}, 0.03};
};

/// The frequency at a share of a wedge in hundreds, right of a place.
void Iso12233::write(double share, double x, double y) {
  const Point where = at(x, y - text_height / 2);
  add_text(dark_.outlines, fmt::format("{:.3g}", (first_ + (most_ - first_) * share) / 100), where.x, where.y,
           text_height * unit_);
}

void Iso12233::upright_wedge(Point middle) {
  const Point top = at(middle.x, middle.y - length / 2);
  add_wedge(dark_, length * unit_, frequency(first_), frequency(most_), [&](double along, double beside) {
    return Point{top.x + beside, top.y + along};
  });
  for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0})
    write(share, middle.x + half_width(share) + 0.2, middle.y + length * (share - 0.5));
}

void Iso12233::level_wedge(Point middle) {
  const Point left = at(middle.x - length / 2, middle.y);
  add_wedge(dark_, length * unit_, frequency(first_), frequency(most_), [&](double along, double beside) {
    return Point{left.x + along, left.y + beside};
  });
  for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0})
    write(share, middle.x + length * (share - 0.5), middle.y + half_width(share) + 0.4);
}

}  // namespace

FigureChart iso12233_figures(ChartFrame frame, const ChartParameter& parameter) {
  const int most = whole_of(parameter, "iso12233", std::max(200, static_cast<int>(frame.height)), 200, 20000);
  return Iso12233(frame, most).draw();
}

FigureChart dots_figures(ChartFrame frame, const ChartParameter& parameter) {
  const int across = whole_of(parameter, "dots", 16, 1, 1000);
  const double pitch = frame.width / across, radius = pitch / 4;
  const int down = std::max(1, static_cast<int>(frame.height / pitch + 1e-9));
  FigureChart chart;
  ChartFigure& dark = chart.figures.emplace_back();
  const int corners = std::max(12, chords_of_arc(radius, 2 * pi));
  for (int row = 0; row < down; ++row)
    for (int column = 0; column < across; ++column) {
      const Point middle{(column + 0.5) * pitch, frame.centre().y + (row - 0.5 * (down - 1)) * pitch};
      std::vector<Point>& disc = dark.outlines.emplace_back();
      for (int i = 0; i < corners; ++i)
        disc.push_back({middle.x + radius * std::cos(2 * pi * i / corners),
                        middle.y + radius * std::sin(2 * pi * i / corners)});
    }
  return chart;
}

FigureChart slanted_board_figures(ChartFrame frame, const ChartParameter& parameter) {
  constexpr double light = 0.8, turn_deg = 5;
  const int across = whole_of(parameter, "slanted-board", 12, 1, 200);
  const double side = frame.width / across, c = side * std::cos(radians(turn_deg)),
               s = side * std::sin(radians(turn_deg));
  const int reach = static_cast<int>(std::hypot(frame.width, frame.height) / 2 / side) + 1;
  FigureChart chart{light, {{{}, light / 4}}};
  for (int row = -reach; row <= reach; ++row)
    for (int column = -reach; column <= reach; ++column) {
      const Point middle{frame.centre().x + column * c - row * s, frame.centre().y + column * s + row * c};
      const bool is_near = std::abs(middle.x - frame.centre().x) < frame.width / 2 + side &&
                           std::abs(middle.y - frame.centre().y) < frame.height / 2 + side;
      if ((row + column) % 2 != 0 && is_near)
        chart.figures.front().outlines.push_back(turned_square(middle, side, turn_deg));
    }
  return chart;
}

FigureChart chessboard_figures(ChartFrame frame, const ChartParameter& parameter) {
  const int across = whole_of(parameter, "chessboard", 10, 2, 500);
  int down = std::max(2, static_cast<int>((across + 2) * frame.height / frame.width + 1e-9) - 2);
  if ((across + down) % 2 == 0) down = std::max(down - 1, 1);
  const double side = std::min(frame.width / (across + 2), frame.height / (down + 2));
  const double left = frame.centre().x - 0.5 * across * side, top = frame.centre().y - 0.5 * down * side;
  FigureChart chart;
  ChartFigure& dark = chart.figures.emplace_back();
  for (int row = 0; row < down; ++row)
    for (int column = row % 2; column < across; column += 2)
      dark.outlines.push_back(
          box(left + column * side, top + row * side, left + (column + 1) * side, top + (row + 1) * side));
  return chart;
}

}  // namespace petzval
