// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/scene/shape.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace petzval {

namespace {

/// Coverage below this is rounding of the sums, not light.
constexpr double rounding = 1e-12;

double twice_signed_area(std::span<const Point> corners) {
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Point a = corners[i], b = corners[(i + 1) % corners.size()];
    sum += a.x * b.y - b.x * a.y;
  }
  return sum;
}

double x_at(Point a, Point b, double y) {
  return a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y);
}

/// Adds what lies to the right of a piece of an edge within one row, as differences from pixel to pixel. The
/// piece spans `height` of the row (signed) and goes from x = from to x = to, both within the row's pixels.
void add_piece(std::span<double> differences, double from, double to, double height) {
  if (from > to) std::swap(from, to);
  const std::size_t last = differences.size() - 1;  // a place for what lies right of the picture
  const std::size_t first_pixel = std::min(static_cast<std::size_t>(from), last);
  double covered_before = 0;  // running sum that belongs in the pixels up to here
  for (std::size_t pixel = first_pixel; pixel <= last; ++pixel) {
    const double left = static_cast<double>(pixel), right = left + 1;
    // The part of the piece within this pixel, and the area to the right of it.
    const double begin = std::clamp(from, left, right), end = std::clamp(to, left, right);
    const double part = to > from ? (end - begin) / (to - from) : 1.0;
    const double passed = to > from ? (begin - from) / (to - from) : 0.0;
    const double area = height * (passed + part * (right - (begin + end) / 2));
    differences[pixel] += area - covered_before;
    covered_before = area;
    if (to <= right) {
      if (pixel < last) differences[pixel + 1] += height - area;
      return;
    }
  }
}

}  // namespace

void Shape::add_polygon(std::span<const Point> corners) {
  const bool turned = twice_signed_area(corners) < 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    Edge edge{corners[i], corners[(i + 1) % corners.size()]};
    if (turned) std::swap(edge.from, edge.to);
    edges_.push_back(edge);
    top_ = std::min(top_, edge.from.y);
    bottom_ = std::max(bottom_, edge.from.y);
    top_ = std::min(top_, edge.to.y);
    bottom_ = std::max(bottom_, edge.to.y);
  }
}

void Shape::add_rectangle(double left, double top, double right, double bottom) {
  add_polygon(std::array<Point, 4>{{{left, top}, {right, top}, {right, bottom}, {left, bottom}}});
}

void Shape::add_disc(Point centre, double radius, int corners) {
  std::vector<Point> circle;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * pi * i / corners;
    circle.push_back({centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)});
  }
  add_polygon(circle);
}

void Shape::add_square(Point centre, double side, double angle_rad) {
  const double c = std::cos(angle_rad) * side / 2, s = std::sin(angle_rad) * side / 2;
  add_polygon(std::array<Point, 4>{{{centre.x - c + s, centre.y - s - c},
                                    {centre.x + c + s, centre.y + s - c},
                                    {centre.x + c - s, centre.y + s + c},
                                    {centre.x - c - s, centre.y - s + c}}});
}

void Shape::coverage(int row, std::span<double> pixels) const {
  std::vector<double> differences(pixels.size() + 1, 0.0);
  const double width = static_cast<double>(pixels.size());
  for (const Edge& edge : edges_) {
    // The part of the edge within this row; going up it opens the shape, going down it closes it.
    const double low = std::max<double>(row, std::min(edge.from.y, edge.to.y));
    const double high = std::min<double>(row + 1.0, std::max(edge.from.y, edge.to.y));
    if (!(low < high)) continue;
    const double sign = edge.from.y > edge.to.y ? 1.0 : -1.0;
    // Cut where it leaves the picture; the pieces outside are moved to its border, which keeps the areas
    // inside.
    std::array<double, 4> cuts = {low, high, high, high};
    int count = 1;
    for (double border : {0.0, width}) {
      if ((edge.from.x < border) == (edge.to.x < border)) continue;
      const double y =
          edge.from.y + (edge.to.y - edge.from.y) * (border - edge.from.x) / (edge.to.x - edge.from.x);
      if (y > low && y < high) cuts[static_cast<std::size_t>(count++)] = y;
    }
    std::sort(cuts.begin(), cuts.end());
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      if (!(cuts[i] < cuts[i + 1])) continue;
      const double from = std::clamp(x_at(edge.from, edge.to, cuts[i]), 0.0, width);
      const double to = std::clamp(x_at(edge.from, edge.to, cuts[i + 1]), 0.0, width);
      add_piece(differences, from, to, sign * (cuts[i + 1] - cuts[i]));
    }
  }
  double sum = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    sum += differences[i];
    pixels[i] = std::abs(sum) < rounding ? 0.0 : std::clamp(sum, 0.0, 1.0);
  }
}

}  // namespace petzval
