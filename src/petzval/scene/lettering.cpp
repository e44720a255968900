// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/scene/lettering.h>
#include <petzval/scene/shape_cuts.h>

#include <array>
#include <cmath>
#include <utility>

namespace petzval {

namespace {

// Letters stand on a grid of 5 × 7 points, small ones on its lower five rows and with their tails on two rows
// below; strokes are 0.9 of a grid step wide, with square ends.
constexpr double stroke = 0.9;
constexpr double box_width = 4 + stroke, box_height = 6 + stroke;
constexpr double advance = box_width + 1.3;

/// The strokes of a letter: points "xy" (y down), a bar lifts the pen. Empty for what has no letter.
std::string_view strokes_of(char letter) {
  constexpr std::array<std::pair<char, std::string_view>, 76> letters = {{
      {'A', "06 20 46|14 34"},
      {'B', "00 06 36 45 44 33 03|33 42 41 30 00"},
      {'C', "41 30 10 01 05 16 36 45"},
      {'D', "00 06 26 44 42 20 00"},
      {'E', "40 00 06 46|03 33"},
      {'F', "40 00 06|03 33"},
      {'G', "41 30 10 01 05 16 36 45 43 23"},
      {'H', "00 06|40 46|03 43"},
      {'I', "10 30|20 26|16 36"},
      {'J', "40 45 36 16 05"},
      {'K', "00 06|40 03 46"},
      {'L', "00 06 46"},
      {'M', "06 00 23 40 46"},
      {'N', "06 00 46 40"},
      {'O', "10 30 41 45 36 16 05 01 10"},
      {'P', "06 00 30 41 42 33 03"},
      {'Q', "10 30 41 45 36 16 05 01 10|24 46"},
      {'R', "06 00 30 41 42 33 03|23 46"},
      {'S', "41 30 10 01 02 13 33 44 45 36 16 05"},
      {'T', "00 40|20 26"},
      {'U', "00 05 16 36 45 40"},
      {'V', "00 26 40"},
      {'W', "00 16 23 36 40"},
      {'X', "00 46|40 06"},
      {'Y', "00 23 40|23 26"},
      {'Z', "00 40 06 46"},
      {'0', "10 30 41 45 36 16 05 01 10|15 31"},
      {'1', "11 20 26|16 36"},
      {'2', "01 10 30 41 42 06 46"},
      {'3', "01 10 30 41 42 33 44 45 36 16 05|23 33"},
      {'4', "36 30 04 44"},
      {'5', "40 00 03 33 44 45 36 16 05"},
      {'6', "41 30 10 01 05 16 36 45 44 33 03"},
      {'7', "00 40 16"},
      {'8', "13 02 01 10 30 41 42 33 13 04 05 16 36 45 44 33"},
      {'9', "05 16 36 45 41 30 10 01 02 13 43"},
      {'.', "26 26"},
      {'-', "13 33"},
      {'/', "06 40"},
      {'a', "12 32 43 46 16 05 14 44"},
      {'b', "00 06 36 45 43 32 02"},
      {'c', "42 12 03 05 16 46"},
      {'d', "40 46 16 05 03 12 42"},
      {'e', "04 44 43 32 12 03 05 16 46"},
      {'f', "40 30 21 26|03 33"},
      {'g', "46 16 05 03 12 42 47 38 08"},
      {'h', "00 06|02 32 43 46"},
      {'i', "12 22 26|16 36|20 20"},
      {'j', "22 32 37 28 08|30 30"},
      {'k', "00 06|42 04 46"},
      {'l', "10 20 25 36"},
      {'m', "06 02 12 23 26|23 32 43 46"},
      {'n', "06 02 32 43 46"},
      {'o', "12 32 43 45 36 16 05 03 12"},
      {'p', "08 02 32 43 45 36 06"},
      {'q', "48 42 12 03 05 16 46"},
      {'r', "06 02|04 22 42"},
      {'s', "42 12 03 14 34 45 36 06"},
      {'t', "10 15 26 46|02 32"},
      {'u', "02 05 16 46|42 46"},
      {'v', "02 26 42"},
      {'w', "02 16 23 36 42"},
      {'x', "02 46|42 06"},
      {'y', "02 05 16 46|42 47 38 08"},
      {'z', "02 42 06 46"},
      {':', "22 22|26 26"},
      {',', "25 26 17"},
      {'=', "02 42|04 44"},
      {'+', "04 44|22 26"},
      {'_', "07 47"},
      {'%', "06 40|00 10 11 01 00|35 45 46 36 35"},
      {'@', "46 16 05 01 10 30 41 44 24 22 42"},
      {'(', "30 21 25 36"},
      {')', "10 21 25 16"},
      {'[', "30 10 16 36"},
      {']', "10 30 36 16"},
  }};
  for (const auto& [known, strokes] : letters)
    if (known == letter) return strokes;
  return "";
}

/// A straight stroke with square ends, as a rectangle around the line.
std::vector<Point> stroke_outline(Point from, Point to, double width) {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  const Point along = length > 0 ? Point{(to.x - from.x) / length, (to.y - from.y) / length} : Point{1, 0};
  const double half = width / 2;
  const Point end{half * along.x, half * along.y}, side{-half * along.y, half * along.x};
  return {{from.x - end.x - side.x, from.y - end.y - side.y},
          {to.x + end.x - side.x, to.y + end.y - side.y},
          {to.x + end.x + side.x, to.y + end.y + side.y},
          {from.x - end.x + side.x, from.y - end.y + side.y}};
}

}  // namespace

void add_text(Shape& shape, std::string_view text, double left, double top, double height) {
  std::vector<std::vector<Point>> strokes;
  add_text(strokes, text, left, top, height);
  const Shape letters = united(strokes);
  for (const Shape::Edge& edge : letters.edges()) shape.add_edge(edge);
}

void add_text(std::vector<std::vector<Point>>& outlines, std::string_view text, double left, double top,
              double height) {
  const double step = height / box_height;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const double x0 = left + step * (advance * static_cast<double>(i) + stroke / 2),
                 y0 = top + step * stroke / 2;
    const std::string_view strokes = strokes_of(text[i]);
    const auto point = [&](std::size_t at) {
      return Point{x0 + step * (strokes[at] - '0'), y0 + step * (strokes[at + 1] - '0')};
    };
    for (std::size_t at = 0; at + 5 <= strokes.size(); at += 3)
      if (strokes[at + 2] == ' ') outlines.push_back(stroke_outline(point(at), point(at + 3), step * stroke));
  }
}

double text_descent(double height) {
  constexpr double rows_below = 2;
  return height / box_height * rows_below;
}

double text_width(std::string_view text, double height) {
  if (text.empty()) return 0;
  return height / box_height * (advance * static_cast<double>(text.size() - 1) + box_width);
}

}  // namespace petzval
