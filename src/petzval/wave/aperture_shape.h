// SPDX-License-Identifier: BSD-3-Clause
// The outline of a pupil: a circle or the blades of an iris.
#pragma once

#include <vector>

namespace petzval {

/// An iris of `blades` equal blades whose corners lie on the unit circle, or that circle itself, with a round
/// obstruction in its middle.
struct ApertureShape {
  int blades = 0;           ///< 0: round; else at least 3
  double rotation_rad = 0;  ///< of a corner, from +x towards +y
  double curvature = 0;     ///< of the blades' edges over the circle's: 0 straight, 1 the circle
  double obstruction = 0;   ///< radius over that of the unit circle, below 1

  bool is_round() const { return blades == 0; }
  /// Distance from the centre to the middle of an edge.
  double inner_radius() const;
  double area() const;
  double perimeter() const;  ///< of all rims, that of the obstruction included
  /// \throws InputError for numbers of blades below 3 or above 1000, a curvature outside [0, 1], or an
  /// obstruction that the blades would reach.
  void validate() const;
};

/// A stretch of an outline over which x is one smooth function of y.
struct OutlinePiece {
  double low = 0, high = 0;  ///< range of y
  bool is_arc = false;
  double centre_x = 0, centre_y = 0, radius = 0;  ///< of an arc
  double x = 0, slope = 0;                        ///< of a straight piece: x at `low`, dx/dy
  bool is_right = false;                          ///< the inside lies on its left, towards −x

  double at(double y) const;
};

/// The rim (without the obstruction) of the shape turned by −angle_rad, that is in axes of which x points
/// along angle_rad, as pieces that are smooth in y. Convex: at any height there are one right and one left
/// piece.
std::vector<OutlinePiece> outline_of(const ApertureShape& shape, double angle_rad);

}  // namespace petzval
