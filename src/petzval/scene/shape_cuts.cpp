// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/scene/shape_cuts.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

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

struct Box {
  Point low{1e300, 1e300}, high{-1e300, -1e300};

  explicit Box(const Shape& shape) {
    for (const Shape::Edge& edge : shape.edges()) {
      low = {std::min(low.x, edge.from.x), std::min(low.y, edge.from.y)};
      high = {std::max(high.x, edge.from.x), std::max(high.y, edge.from.y)};
    }
  }
  bool overlaps(const Box& other) const {
    return low.x < other.high.x && other.low.x < high.x && low.y < other.high.y && other.low.y < high.y;
  }
};

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
  ClipperLib::Clipper clipper;
  clipper.AddPaths(to_clipper(outlines_of(directed)), ClipperLib::ptSubject, true);
  ClipperLib::Paths all;
  clipper.Execute(ClipperLib::ctUnion, all, ClipperLib::pftPositive, ClipperLib::pftPositive);
  return shape_of(all);
}

std::vector<Shape> uncovered_parts(std::span<const Shape* const> shapes) {
  std::vector<Box> boxes;
  for (const Shape* shape : shapes) boxes.emplace_back(*shape);
  std::vector<Shape> parts;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    ClipperLib::Paths covers;
    for (std::size_t later = i + 1; later < shapes.size(); ++later)
      if (boxes[i].overlaps(boxes[later]))
        for (ClipperLib::Path& path : to_clipper(outlines_of(*shapes[later])))
          covers.push_back(std::move(path));
    if (covers.empty()) {
      parts.push_back(*shapes[i]);
      continue;
    }
    ClipperLib::Clipper clipper;
    clipper.AddPaths(to_clipper(outlines_of(*shapes[i])), ClipperLib::ptSubject, true);
    clipper.AddPaths(covers, ClipperLib::ptClip, true);
    ClipperLib::Paths rest;
    clipper.Execute(ClipperLib::ctDifference, rest, ClipperLib::pftPositive, ClipperLib::pftPositive);
    parts.push_back(shape_of(rest));
  }
  return parts;
}

}  // namespace petzval
