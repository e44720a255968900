// SPDX-License-Identifier: BSD-3-Clause
// Plane figures, and how much of each pixel they cover: exactly.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace petzval {

/// A point of a picture [pixels], x to the right, y down, the corner of the first pixel at (0, 0).
struct Point {
  double x = 0, y = 0;
  bool operator==(const Point&) const = default;
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

  /// From one corner to the next, the inside on the same side of all.
  struct Edge {
    Point from, to;
  };
  std::span<const Edge> edges() const { return edges_; }
  /// Edges of a shape that is closed once all are there.
  void add_edge(Edge edge);

  bool empty() const { return edges_.empty(); }
  double top() const { return top_; }
  double bottom() const { return bottom_; }

  /// The area of each pixel of a row inside the shape, 0 to 1. Signed areas under the edges are added up
  /// along the row, so there is no sampling. \param row  from 0; the shape may reach beyond the picture on
  /// all sides.
  void coverage(int row, std::span<double> pixels) const;

 private:
  std::vector<Edge> edges_;
  double top_ = 1e300, bottom_ = -1e300;
};

/// Shapes over a picture, each of a value, their edges sorted by rows: for shapes of many edges, and many
/// shapes.
class ShapesInPicture {
 public:
  struct Valued {
    const Shape* shape;
    double value = 1;
  };
  /// \param shapes  looked at here only.
  ShapesInPicture(std::span<const Valued> shapes, int columns, int rows);

  /// Pixels [from, end) of a row.
  struct Reach {
    std::size_t from = 0, end = 0;
  };
  /// As Shape::coverage(), of all shapes together. \param pixels  of the whole row; only those within what is
  /// returned are set, all others lie outside the shapes.
  Reach coverage(int row, std::span<double> pixels) const;
  /// The same, and the sum of value × coverage. \param values  as `pixels`.
  Reach coverage(int row, std::span<float> pixels, std::span<float> values) const;

 private:
  struct Edge {
    Shape::Edge edge;
    double value;
  };
  std::span<const Edge> edges_of(int row) const;
  Reach reach_of(std::span<const Edge> edges) const;

  std::size_t columns_;
  std::vector<std::size_t> first_;  ///< of each row in `edges_`, and the end
  std::vector<Edge> edges_;         ///< of row after row
};

}  // namespace petzval
