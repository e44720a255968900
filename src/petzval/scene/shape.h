// SPDX-License-Identifier: BSD-3-Clause
// Plane figures, and how much of each pixel they cover: exactly.
#pragma once

#include <span>
#include <vector>

namespace petzval {

/// A point of a picture [pixels], x to the right, y down, the corner of the first pixel at (0, 0).
struct Point {
  double x = 0, y = 0;
};

/// A set of polygons that do not overlap each other. Where they do, a pixel counts as covered at most once;
/// only pixels on the edge of an overlap are then not exact.
///
///     Shape shape;
///     shape.add_rectangle(10, 10, 20, 15);
///     std::vector<double> coverage(columns);
///     shape.coverage(12, coverage);   // of the pixels of row 12
class Shape {
 public:
  /// A closed polygon, either way round.
  void add_polygon(std::span<const Point> corners);
  void add_rectangle(double left, double top, double right, double bottom);
  /// Of this many corners.
  void add_disc(Point centre, double radius, int corners = 128);
  /// A square of this side, turned by an angle (clockwise in the picture).
  void add_square(Point centre, double side, double angle_rad);

  bool empty() const { return edges_.empty(); }
  double top() const { return top_; }
  double bottom() const { return bottom_; }

  /// The area of each pixel of a row inside the shape, 0 to 1. Signed areas under the edges are added up
  /// along the row, so there is no sampling. \param row  from 0; the shape may reach beyond the picture on
  /// all sides.
  void coverage(int row, std::span<double> pixels) const;

 private:
  struct Edge {
    Point from, to;
  };
  std::vector<Edge> edges_;
  double top_ = 1e300, bottom_ = -1e300;
};

}  // namespace petzval
