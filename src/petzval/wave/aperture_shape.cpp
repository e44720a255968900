// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/wave/aperture_shape.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

constexpr int most_blades = 1000;
/// Below this curvature an edge is taken as straight: it bulges by less than 1e-10 of the radius.
constexpr double straight_below = 1e-9;

/// Centre of a blade's arc on the bisector of its two corners, from the middle of the pupil.
double arc_offset(const ApertureShape& shape) {
  const double half = pi / shape.blades, radius = 1 / shape.curvature;
  return std::cos(half) - std::sqrt(radius * radius - std::sin(half) * std::sin(half));
}

/// Half the angle of a blade's arc about its own centre.
double arc_half_angle(const ApertureShape& shape) {
  return std::asin(std::sin(pi / shape.blades) * shape.curvature);
}

void add_arc(std::vector<OutlinePiece>& pieces, double cx, double cy, double radius, double from, double to) {
  // Split where the outline turns from rising to falling, at ±90° and so on.
  std::vector<double> ends{from};
  for (double turn = (std::floor(from / pi - 0.5) + 1.5) * pi; turn < to; turn += pi)
    if (turn > from) ends.push_back(turn);
  ends.push_back(to);
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    OutlinePiece piece;
    piece.is_arc = true;
    piece.centre_x = cx, piece.centre_y = cy, piece.radius = radius;
    piece.is_right = std::cos(0.5 * (ends[i] + ends[i + 1])) > 0;
    const double a = cy + radius * std::sin(ends[i]), b = cy + radius * std::sin(ends[i + 1]);
    piece.low = std::min(a, b), piece.high = std::max(a, b);
    pieces.push_back(piece);
  }
}

void add_segment(std::vector<OutlinePiece>& pieces, double ax, double ay, double bx, double by) {
  if (ay == by) return;
  OutlinePiece piece;
  piece.is_right = by > ay;  // the outline runs against the clock
  piece.low = std::min(ay, by), piece.high = std::max(ay, by);
  piece.slope = (bx - ax) / (by - ay);
  piece.x = by > ay ? ax : bx;
  pieces.push_back(piece);
}

}  // namespace

double ApertureShape::inner_radius() const {
  if (is_round()) return 1;
  if (curvature < straight_below) return std::cos(pi / blades);
  return arc_offset(*this) + 1 / curvature;
}

double ApertureShape::area() const {
  double open = pi;
  if (!is_round()) {
    const double half = pi / blades;
    open = 0.5 * blades * std::sin(2 * half);
    if (curvature >= straight_below) {
      const double angle = arc_half_angle(*this), radius = 1 / curvature;
      open += blades * radius * radius * (angle - 0.5 * std::sin(2 * angle));
    }
  }
  return open - pi * obstruction * obstruction;
}

double ApertureShape::perimeter() const {
  double rim = 2 * pi;
  if (!is_round())
    rim =
        2 * blades * (curvature < straight_below ? std::sin(pi / blades) : arc_half_angle(*this) / curvature);
  return rim + 2 * pi * obstruction;
}

void ApertureShape::validate() const {
  if (blades != 0 && (blades < 3 || blades > most_blades))
    throw InputError(fmt::format("{} aperture blades: 3 to {} are right", blades, most_blades));
  if (!std::isfinite(rotation_rad)) throw InputError("the rotation of the aperture blades is not a number");
  if (!(curvature >= 0 && curvature <= 1))
    throw InputError(
        fmt::format("a blade curvature of {}: from 0 (straight) to 1 (the circle) is right", curvature));
  if (!(obstruction >= 0 && obstruction < 1))
    throw InputError(fmt::format(
        "a central obstruction of {}: its radius over the pupil's is from 0 to below 1", obstruction));
  if (obstruction >= inner_radius())
    throw InputError(
        fmt::format("a central obstruction of {} reaches the blades, which stand {:.6g} from the "
                    "centre; a smaller one is right",
                    obstruction, inner_radius()));
}

double OutlinePiece::at(double y) const {
  if (!is_arc) return x + slope * (y - low);
  const double d = y - centre_y, across = std::sqrt(std::max(0.0, radius * radius - d * d));
  return is_right ? centre_x + across : centre_x - across;
}

std::vector<OutlinePiece> outline_of(const ApertureShape& shape, double angle_rad) {
  std::vector<OutlinePiece> pieces;
  if (shape.is_round()) {
    add_arc(pieces, 0, 0, 1, -pi / 2, 3 * pi / 2);
    return pieces;
  }
  const double half = pi / shape.blades;
  for (int i = 0; i < shape.blades; ++i) {
    const double from = shape.rotation_rad - angle_rad + 2 * half * i, middle = from + half;
    if (shape.curvature < straight_below) {
      add_segment(pieces, std::cos(from), std::sin(from), std::cos(from + 2 * half),
                  std::sin(from + 2 * half));
    } else {
      const double offset = arc_offset(shape), angle = arc_half_angle(shape);
      add_arc(pieces, offset * std::cos(middle), offset * std::sin(middle), 1 / shape.curvature,
              middle - angle, middle + angle);
    }
  }
  return pieces;
}

}  // namespace petzval
