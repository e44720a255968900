// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/target/stroke_font.h>

#include <charconv>
#include <cmath>
#include <map>
#include <string_view>

namespace petzval {

namespace {

// Letters stand on a grid of 8 × 12, y down.
constexpr double grid_height = 12, advance = 11.5, letter_width = 8, half_stroke = 0.8, small_scale = 0.75;

/// Strokes as corners "x,y", parted by semicolons; a stroke that ends in z is closed.
const std::map<char, std::string_view>& strokes_by_letter() {
  static const std::map<char, std::string_view> letters{
      {' ', ""},
      {'A', "0,12 3,0 5,0 8,12;1,8 7,8"},
      {'B', "0,0 6,0 8,2 8,4 6,6 8,8 8,10 6,12 0,12 z;0,6 6,6"},
      {'C', "8,2 6,0 2,0 0,2 0,10 2,12 6,12 8,10"},
      {'D', "0,0 5,0 8,3 8,9 5,12 0,12 z"},
      {'E', "8,0 0,0 0,12 8,12;0,6 6,6"},
      {'F', "8,0 0,0 0,12;0,6 6,6"},
      {'G', "8,2 6,0 2,0 0,2 0,10 2,12 6,12 8,10 8,6 5,6"},
      {'H', "0,0 0,12;8,0 8,12;0,6 8,6"},
      {'I', "2,0 6,0;4,0 4,12;2,12 6,12"},
      {'J', "8,0 8,10 6,12 2,12 0,10"},
      {'K', "0,0 0,12;8,0 1,6 8,12"},
      {'L', "0,0 0,12 8,12"},
      {'M', "0,12 0,0 4,7 8,0 8,12"},
      {'N', "0,12 0,0 8,12 8,0"},
      {'O', "2,0 6,0 8,2 8,10 6,12 2,12 0,10 0,2 z"},
      {'P', "0,0 0,12;0,0 6,0 8,2 8,4 6,6 0,6"},
      {'Q', "2,0 6,0 8,2 8,10 6,12 2,12 0,10 0,2 z;5,9 8,12"},
      {'R', "0,0 0,12;0,0 6,0 8,2 8,4 6,6 0,6;4,6 8,12"},
      {'S', "8,2 6,0 2,0 0,2 0,4 2,6 6,6 8,8 8,10 6,12 2,12 0,10"},
      {'T', "0,0 8,0;4,0 4,12"},
      {'U', "0,0 0,10 2,12 6,12 8,10 8,0"},
      {'V', "0,0 4,12 8,0"},
      {'W', "0,0 2,12 4,3 6,12 8,0"},
      {'X', "0,0 8,12;8,0 0,12"},
      {'Y', "0,0 4,6 8,0;4,6 4,12"},
      {'Z', "0,0 8,0 0,12 8,12"},
      {'0', "2,0 6,0 8,2 8,10 6,12 2,12 0,10 0,2 z;2,9 6,3"},
      {'1', "1,3 4,0 4,12;1,12 7,12"},
      {'2', "0,2 2,0 6,0 8,2 8,4 0,12 8,12"},
      {'3', "0,2 2,0 6,0 8,2 8,4 6,6 3,6;6,6 8,8 8,10 6,12 2,12 0,10"},
      {'4', "6,12 6,0 0,8;0,8 8,8"},
      {'5', "8,0 0,0 0,5 6,5 8,7 8,10 6,12 2,12 0,10"},
      {'6', "7,0 3,0 0,3 0,10 2,12 6,12 8,10 8,7 6,5 2,5;2,5 0,7"},
      {'7', "0,0 8,0 3,12"},
      {'8', "2,0 6,0 8,2 8,4 6,6 8,8 8,10 6,12 2,12 0,10 0,8 2,6 0,4 0,2 z;2,6 6,6"},
      {'9', "1,12 5,12 8,9 8,2 6,0 2,0 0,2 0,5 2,7 6,7;6,7 8,5"},
      {'.', "4,11 4,12"},
      {',', "5,11 3,14"},
      {':', "4,3 4,4;4,9 4,10"},
      {';', "4,3 4,4;5,9 3,12"},
      {'-', "1,6 7,6"},
      {'+', "1,6 7,6;4,3 4,9"},
      {'=', "1,4 7,4;1,8 7,8"},
      {'/', "0,12 8,0"},
      {'(', "6,0 4,2 4,10 6,12"},
      {')', "2,0 4,2 4,10 2,12"},
      {'\'', "4,0 4,3"},
      {'!', "4,0 4,8;4,11 4,12"},
      {'?', "0,2 2,0 6,0 8,2 8,4 4,7 4,8;4,11 4,12"},
  };
  return letters;
}

struct Stroke {
  std::vector<Vertex> corners;
  bool is_closed = false;
};

std::vector<Stroke> parsed_strokes(std::string_view text) {
  std::vector<Stroke> strokes;
  while (!text.empty()) {
    const std::string_view one = text.substr(0, text.find(';'));
    text.remove_prefix(std::min(text.size(), one.size() + 1));
    Stroke stroke;
    const char *at = one.data(), *const end = at + one.size();
    while (at < end) {
      if (*at == ' ') ++at;
      if (*at == 'z') {
        stroke.is_closed = true;
        break;
      }
      int x = 0, y = 0;
      at = std::from_chars(at, end, x).ptr + 1;
      at = std::from_chars(at, end, y).ptr;
      stroke.corners.push_back({static_cast<double>(x), static_cast<double>(y)});
    }
    strokes.push_back(std::move(stroke));
  }
  return strokes;
}

Vertex direction(const Vertex& a, const Vertex& b) {
  const double length = std::hypot(b.x - a.x, b.y - a.y);
  return {(b.x - a.x) / length, (b.y - a.y) / length};
}

/// The line that runs half a stroke to one side (+1: where +y is, of a stroke along +x) of the corner between
/// two directions. Outside of sharp corners it is cut off square.
void add_corner(Contour& line, const Vertex& corner, const Vertex& before, const Vertex& after, double side) {
  const double w = side * half_stroke, along = before.x * after.x + before.y * after.y;
  const double turn = before.x * after.y - before.y * after.x;
  constexpr double sharp = -0.5;  // the cosine of 120°: the mitre is then two strokes long
  if (along < sharp && turn * side < 0) {
    line.push_back(
        {corner.x - w * before.y + std::abs(w) * before.x, corner.y + w * before.x + std::abs(w) * before.y});
    line.push_back(
        {corner.x - w * after.y - std::abs(w) * after.x, corner.y + w * after.x - std::abs(w) * after.y});
    return;
  }
  // The sum of the two normals, as long as meets both lines.
  const double scale = w / (1 + along);
  line.push_back({corner.x - scale * (before.y + after.y), corner.y + scale * (before.x + after.x)});
}

/// One side of a stroke.
Contour side_of(const Stroke& stroke, double side) {
  Contour line;
  const std::vector<Vertex>& p = stroke.corners;
  const std::size_t n = p.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (stroke.is_closed) {
      add_corner(line, p[i], direction(p[(i + n - 1) % n], p[i]), direction(p[i], p[(i + 1) % n]), side);
    } else if (i == 0 || i + 1 == n) {
      // Ends reach half a stroke beyond.
      const Vertex d = i == 0 ? direction(p[0], p[1]) : direction(p[n - 2], p[n - 1]);
      const double out = i == 0 ? -half_stroke : half_stroke, w = side * half_stroke;
      line.push_back({p[i].x + out * d.x - w * d.y, p[i].y + out * d.y + w * d.x});
    } else {
      add_corner(line, p[i], direction(p[i - 1], p[i]), direction(p[i], p[i + 1]), side);
    }
  }
  return line;
}

Polygon outlined(const Stroke& stroke) {
  Contour left = side_of(stroke, 1), right = side_of(stroke, -1);
  if (stroke.is_closed) return {{std::move(left), std::move(right)}, 0, 0};
  left.insert(left.end(), right.rbegin(), right.rend());
  return {{std::move(left)}, 0, 0};
}

struct Letter {
  std::string_view strokes;
  double scale = 1;
};

Letter letter_of(char character) {
  const auto& letters = strokes_by_letter();
  const bool is_small = character >= 'a' && character <= 'z';
  const auto found = letters.find(is_small ? static_cast<char>(character - 'a' + 'A') : character);
  if (found == letters.end())
    throw InputError(
        fmt::format("there is no shape for {}; A to Z, a to z, 0 to 9, blanks and . , : ; - + = / ( ) ' "
                    "! ? are right",
                    character > ' ' && character < 127
                        ? fmt::format("'{}'", character)
                        : fmt::format("the byte {}", static_cast<unsigned char>(character))));
  return {found->second, is_small ? small_scale : 1};
}

void require_valid(const TextStyle& style) {
  if (!(style.height_px > 0 && style.height_px <= target_reach_px) || !std::isfinite(style.angle_deg))
    throw InputError(
        fmt::format("letters {:g} pixels high at {:g} degrees: a height above 0 and up to {:g} is right",
                    style.height_px, style.angle_deg, target_reach_px));
}

}  // namespace

double text_width(const std::string& text, const TextStyle& style) {
  require_valid(style);
  double width = 0, gap = 0;
  for (const char character : text) {
    const double scale = letter_of(character).scale;
    width += gap + letter_width * scale;
    gap = (advance - letter_width) * scale;
  }
  return width * style.height_px / grid_height;
}

std::vector<Polygon> text_polygons(const std::string& text, Vertex corner, const TextStyle& style) {
  require_valid(style);
  const double unit = style.height_px / grid_height;
  const double c = unit * std::cos(style.angle_deg * pi / 180),
               s = unit * std::sin(style.angle_deg * pi / 180);
  std::vector<Polygon> polygons;
  double pen = 0;
  for (const char character : text) {
    const Letter letter = letter_of(character);
    for (const Stroke& stroke : parsed_strokes(letter.strokes)) {
      Polygon polygon = outlined(stroke);
      polygon.level = style.level;
      for (Contour& contour : polygon.contours)
        for (Vertex& v : contour) {
          const double x = pen + letter.scale * v.x,
                       y = grid_height * (1 - letter.scale) + letter.scale * v.y;
          v = {corner.x + c * x - s * y, corner.y + s * x + c * y};
        }
      polygons.push_back(std::move(polygon));
    }
    pen += advance * letter.scale;
  }
  if (polygons.empty()) throw InputError("text without a letter");
  return polygons;
}

}  // namespace petzval
