// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/scene/shape_cuts.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>

namespace petzval {

namespace {

constexpr double clipper_scale = 1 << 24;

/// The outlines of a shape: edges follow one another until one returns to where the first began.
std::vector<std::vector<Point>> outlines_of(const Shape& shape) {
  std::vector<std::vector<Point>> outlines;
  bool closed = true;
  for (const Shape::Edge& edge : shape.edges()) {
    if (closed) outlines.emplace_back();
    outlines.back().push_back(edge.from);
    closed = edge.to == outlines.back().front();
  }
  return outlines;
}

/// Clipper directs outlines as shapes have them: holes run the other way round.
Shape shape_of(const ClipperLib::Paths& paths) {
  Shape shape;
  for (const std::vector<Point>& outline : from_clipper(paths))
    for (std::size_t i = 0; i < outline.size(); ++i)
      shape.add_edge({outline[i], outline[(i + 1) % outline.size()]});
  return shape;
}

using ClipperLib::cInt;
using ClipperLib::Path;
using ClipperLib::Paths;

struct Box {
  std::array<cInt, 2> low{}, high{};  ///< by axis

  explicit Box(std::span<const Path> paths) {
    low.fill(std::numeric_limits<cInt>::max());
    high.fill(std::numeric_limits<cInt>::min());
    for (const Path& path : paths)
      for (const ClipperLib::IntPoint& p : path) {
        low = {std::min(low[0], p.X), std::min(low[1], p.Y)};
        high = {std::max(high[0], p.X), std::max(high[1], p.Y)};
      }
  }
  explicit Box(const Path& path) : Box(std::span(&path, 1)) {}
  bool overlaps(const Box& other) const {
    return low[0] < other.high[0] && other.low[0] < high[0] && low[1] < other.high[1] &&
           other.low[1] < high[1];
  }
  bool contains(const Box& other) const {
    return low[0] <= other.low[0] && other.high[0] <= high[0] && low[1] <= other.low[1] &&
           other.high[1] <= high[1];
  }
  cInt length(int axis) const { return high[axis] - low[axis]; }
  Path outline() const {
    return {{low[0], low[1]}, {high[0], low[1]}, {high[0], high[1]}, {low[0], high[1]}};
  }
};

Paths result_of(ClipperLib::ClipType type, const Paths& subject, const Paths& clip) {
  ClipperLib::Clipper clipper;
  clipper.AddPaths(subject, ClipperLib::ptSubject, true);
  clipper.AddPaths(clip, ClipperLib::ptClip, true);
  Paths result;
  clipper.Execute(type, result, ClipperLib::pftPositive, ClipperLib::pftPositive);
  return result;
}

void append(Paths& to, const Paths& paths) {
  to.insert(to.end(), paths.begin(), paths.end());
}

/// What lies in a box.
Paths within(const Paths& paths, const Box& box) {
  Paths inside, across;
  for (const Path& path : paths) {
    const Box reach(path);
    if (box.overlaps(reach)) (box.contains(reach) ? inside : across).push_back(path);
  }
  if (!across.empty()) append(inside, result_of(ClipperLib::ctIntersection, across, {box.outline()}));
  return inside;
}

Paths near(const Paths& paths, const Box& box) {
  Paths result;
  std::ranges::copy_if(paths, std::back_inserter(result),
                       [&](const Path& path) { return box.overlaps(Box(path)); });
  return result;
}

/// What covers leave of a figure is added to `rest`. Clipper's time grows with the square of the number of
/// outlines, so many of them are cut by halves.
void subtract(const Paths& figure, const Paths& covers, Paths& rest) {
  if (figure.empty() || covers.empty()) return append(rest, figure);
  constexpr std::size_t few = 64;
  const std::size_t outlines = figure.size() + covers.size();
  if (outlines > few) {
    const Box whole(figure);
    const int axis = whole.length(0) >= whole.length(1) ? 0 : 1;
    std::array<Box, 2> halves{whole, whole};
    halves[0].high[axis] = halves[1].low[axis] = whole.low[axis] + whole.length(axis) / 2;
    std::array<Paths, 2> parts, near_covers;
    std::size_t most = 0;
    for (int i = 0; i < 2; ++i) {
      parts[i] = within(figure, halves[i]);
      near_covers[i] = near(covers, halves[i]);
      most = std::max(most, parts[i].size() + near_covers[i].size());
    }
    // Where all of them meet in one place, halves help no more.
    if (most * 4 < outlines * 3) {
      for (int i = 0; i < 2; ++i) subtract(parts[i], near_covers[i], rest);
      return;
    }
  }
  append(rest, result_of(ClipperLib::ctDifference, figure, covers));
}

}  // namespace

ClipperLib::Paths to_clipper(std::span<const std::vector<Point>> outlines) {
  ClipperLib::Paths paths;
  for (const std::vector<Point>& outline : outlines) {
    ClipperLib::Path path;
    for (const Point& p : outline)
      path.emplace_back(std::llround(p.x * clipper_scale), std::llround(p.y * clipper_scale));
    paths.push_back(std::move(path));
  }
  return paths;
}

std::vector<std::vector<Point>> from_clipper(const ClipperLib::Paths& paths) {
  std::vector<std::vector<Point>> outlines;
  for (const ClipperLib::Path& path : paths) {
    std::vector<Point>& outline = outlines.emplace_back();
    for (const ClipperLib::IntPoint& p : path)
      outline.push_back({static_cast<double>(p.X) / clipper_scale, static_cast<double>(p.Y) / clipper_scale});
  }
  return outlines;
}

Shape united(std::span<const std::vector<Point>> outlines) {
  Shape directed;  // as add_polygon() turns them
  for (const std::vector<Point>& outline : outlines) directed.add_polygon(outline);
  return shape_of(result_of(ClipperLib::ctUnion, to_clipper(outlines_of(directed)), {}));
}

std::vector<Shape> uncovered_parts(std::span<const Shape* const> shapes) {
  std::vector<Paths> paths;
  std::vector<Box> boxes;
  for (const Shape* shape : shapes) {
    paths.push_back(to_clipper(outlines_of(*shape)));
    boxes.emplace_back(paths.back());
  }
  std::vector<Shape> parts;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    Paths covers;
    for (std::size_t later = i + 1; later < shapes.size(); ++later)
      if (boxes[i].overlaps(boxes[later])) append(covers, near(paths[later], boxes[i]));
    if (covers.empty()) {
      parts.push_back(*shapes[i]);
      continue;
    }
    Paths rest;
    subtract(paths[i], covers, rest);
    parts.push_back(shape_of(rest));
  }
  return parts;
}

}  // namespace petzval
