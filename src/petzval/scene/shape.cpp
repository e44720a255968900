// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/scene/shape.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace petzval {

namespace {

/// Coverage below this is rounding of the sums, not light.
constexpr double rounding = 1e-12;

/// Pixels right of its last that an edge on its border adds to.
constexpr std::size_t beyond = 2;

double twice_signed_area(std::span<const Point> corners) {
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Point a = corners[i], b = corners[(i + 1) % corners.size()];
    sum += a.x * b.y - b.x * a.y;
  }
  return sum;
}

/// Where an edge that is not level is at a height. Between its ends, whatever the rounding: what it adds to a
/// row lies where they say.
class Slope {
 public:
  explicit Slope(const Shape::Edge& edge)
      : from_(edge.from),
        x_per_y_((edge.to.x - edge.from.x) / (edge.to.y - edge.from.y)),
        least_(std::min(edge.from.x, edge.to.x)),
        most_(std::max(edge.from.x, edge.to.x)) {}
  bool is_within(double width) const { return least_ >= 0 && most_ <= width; }
  double x_at(double y) const { return std::clamp(from_.x + x_per_y_ * (y - from_.y), least_, most_); }

 private:
  Point from_;
  double x_per_y_, least_, most_;
};

/// Adds what lies to the right of a piece of an edge within one row, as differences from pixel to pixel. The
/// piece spans `height` of the row (signed) and goes from x = from to x = to, both within the row's pixels.
/// \param last  pixel, a place for what lies right of the picture. \param add  takes a pixel and a
/// difference.
template <typename Add>
void add_piece(std::size_t last, double from, double to, double height, const Add& add) {
  if (from > to) std::swap(from, to);
  const std::size_t first_pixel = std::min(static_cast<std::size_t>(from), last);
  if (const double right = static_cast<double>(first_pixel) + 1;
      to <= right) {  // within one pixel, as most are
    const double area = height * (right - (from + to) / 2);
    add(first_pixel, area);
    if (first_pixel < last) add(first_pixel + 1, height - area);
    return;
  }
  const double per_length = 1 / (to - from);
  double covered_before = 0;  // running sum that belongs in the pixels up to here
  for (std::size_t pixel = first_pixel; pixel <= last; ++pixel) {
    const double left = static_cast<double>(pixel), right = left + 1;
    // The part of the piece within this pixel, and the area to the right of it.
    const double begin = std::clamp(from, left, right), end = std::clamp(to, left, right);
    const double part = (end - begin) * per_length, passed = (begin - from) * per_length;
    const double area = height * (passed + part * (right - (begin + end) / 2));
    add(pixel, area - covered_before);
    covered_before = area;
    if (to <= right) {
      if (pixel < last) add(pixel + 1, height - area);
      return;
    }
  }
}

}  // namespace

void Shape::add_polygon(std::span<const Point> corners) {
  const bool turned = twice_signed_area(corners) < 0;
  const std::size_t count = corners.size();
  for (std::size_t i = 0; i < count; ++i) {
    const auto corner = [&](std::size_t k) { return corners[turned ? count - 1 - k % count : k % count]; };
    add_edge({corner(i), corner(i + 1)});
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

namespace {

/// Adds the part of an edge within a row; going up it opens the shape, going down it closes it.
template <typename Add>
void add_edge_in_row(const Shape::Edge& edge, int row, std::size_t columns, const Add& add) {
  const auto width = double(columns);
  const double low = std::max<double>(row, std::min(edge.from.y, edge.to.y));
  const double high = std::min<double>(row + 1.0, std::max(edge.from.y, edge.to.y));
  if (!(low < high)) return;
  const double sign = edge.from.y > edge.to.y ? 1.0 : -1.0;
  const Slope slope(edge);
  if (slope.is_within(width))
    return add_piece(columns, slope.x_at(low), slope.x_at(high), sign * (high - low), add);
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
    const double from = std::clamp(slope.x_at(cuts[i]), 0.0, width);
    const double to = std::clamp(slope.x_at(cuts[i + 1]), 0.0, width);
    add_piece(columns, from, to, sign * (cuts[i + 1] - cuts[i]), add);
  }
}

/// From what every edge added to what is covered.
void add_up(std::span<const double> differences, std::span<double> pixels) {
  double sum = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    sum += differences[i];
    pixels[i] = std::abs(sum) < rounding ? 0.0 : std::clamp(sum, 0.0, 1.0);
  }
}

}  // namespace

void Shape::add_edge(Edge edge) {
  edges_.push_back(edge);
  for (const double y : {edge.from.y, edge.to.y}) {
    top_ = std::min(top_, y);
    bottom_ = std::max(bottom_, y);
  }
}

void Shape::coverage(int row, std::span<double> pixels) const {
  std::vector<double> differences(pixels.size() + 1, 0.0);
  for (const Edge& edge : edges_)
    add_edge_in_row(edge, row, pixels.size(),
                    [&](std::size_t pixel, double by) { differences[pixel] += by; });
  add_up(differences, pixels);
}

ShapesInPicture::ShapesInPicture(std::span<const Valued> shapes, int columns, int rows)
    : columns_(static_cast<std::size_t>(columns)), first_(static_cast<std::size_t>(rows) + 1) {
  const auto for_rows = [&](const auto& take) {
    for (const auto& [shape, value] : shapes)
      for (const Shape::Edge& edge : shape->edges()) {
        const auto [top, bottom] = std::minmax(edge.from.y, edge.to.y);
        const double last = std::clamp(bottom, 0.0, double(rows));
        auto end = static_cast<std::size_t>(last);
        if (double(end) < last) ++end;
        for (auto at = static_cast<std::size_t>(std::clamp(top, 0.0, double(rows))); at < end; ++at)
          take(at, Edge{edge, value});
      }
  };
  for_rows([&](std::size_t row, const Edge&) { ++first_[row + 1]; });
  for (std::size_t row = 0; row + 1 < first_.size(); ++row) first_[row + 1] += first_[row];
  edges_.resize(first_.back());
  std::vector<std::size_t> next = first_;
  for_rows([&](std::size_t row, const Edge& edge) { edges_[next[row]++] = edge; });
}

std::span<const ShapesInPicture::Edge> ShapesInPicture::edges_of(int row) const {
  const auto at = static_cast<std::size_t>(row);
  return std::span(edges_).subspan(first_[at], first_[at + 1] - first_[at]);
}

ShapesInPicture::Reach ShapesInPicture::reach_of(std::span<const Edge> edges) const {
  double left = double(columns_), right = 0;
  for (const auto& [edge, value] : edges) {
    left = std::min({left, edge.from.x, edge.to.x});
    right = std::max({right, edge.from.x, edge.to.x});
  }
  const auto pixel = [&](double x) { return static_cast<std::size_t>(std::clamp(x, 0.0, double(columns_))); };
  const Reach reach{pixel(std::floor(left)), pixel(std::ceil(right))};
  return reach.from < reach.end ? reach : Reach{};
}

ShapesInPicture::Reach ShapesInPicture::coverage(int row, std::span<double> pixels) const {
  const std::span<const Edge> edges = edges_of(row);
  const Reach reach = reach_of(edges);
  if (reach.from == reach.end) return reach;
  thread_local std::vector<double> differences;
  differences.assign(reach.end - reach.from + beyond, 0.0);
  for (const auto& [edge, value] : edges)
    add_edge_in_row(edge, row, columns_,
                    [&](std::size_t pixel, double by) { differences[pixel - reach.from] += by; });
  add_up(differences, pixels.subspan(reach.from, reach.end - reach.from));
  return reach;
}

ShapesInPicture::Reach ShapesInPicture::coverage(int row, std::span<float> pixels,
                                                 std::span<float> values) const {
  const std::span<const Edge> edges = edges_of(row);
  const Reach reach = reach_of(edges);
  if (reach.from == reach.end) return reach;
  struct Sums {
    double coverage = 0, value = 0;
  };
  // From edge to edge nothing changes: only stretches in which there is one are added up pixel by pixel.
  constexpr std::size_t stretch = 8;
  thread_local std::vector<Sums> differences;  // zero but while this runs
  thread_local std::vector<char> changes;
  const std::size_t stretches = (reach.end - reach.from + beyond) / stretch + 1;
  differences.resize(std::max(differences.size(), stretches * stretch));
  changes.assign(stretches, 0);
  for (const auto& [edge, of_edge] : edges)
    add_edge_in_row(edge, row, columns_, [&, value = of_edge](std::size_t pixel, double by) {
      Sums& difference = differences[pixel - reach.from];
      difference.coverage += by;
      difference.value += value * by;
      changes[(pixel - reach.from) / stretch] = 1;
    });
  Sums sums;
  float covered = 0, light = 0;
  for (std::size_t i = 0; i < stretches; ++i) {
    const std::size_t from = std::min(reach.from + i * stretch, reach.end),
                      end = std::min(from + stretch, reach.end);
    if (changes[i] == 0) {
      std::fill(&pixels[0] + from, &pixels[0] + end, covered);
      std::fill(&values[0] + from, &values[0] + end, light);
      continue;
    }
    Sums* const of_stretch = &differences[i * stretch];
    for (std::size_t pixel = from; pixel < end; ++pixel) {
      sums.coverage += of_stretch[pixel - from].coverage;
      sums.value += of_stretch[pixel - from].value;
      const double scale = sums.coverage < rounding ? 0 : 1 / std::max(sums.coverage, 1.0);
      pixels[pixel] = covered = static_cast<float>(scale * sums.coverage);
      values[pixel] = light = static_cast<float>(scale * sums.value);
    }
    std::fill_n(of_stretch, stretch, Sums{});
  }
  return reach;
}

}  // namespace petzval
