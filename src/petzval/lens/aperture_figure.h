// SPDX-License-Identifier: BSD-3-Clause
// Apertures that are not round, not centred, or closed inside: rectangles, ellipses, rings, obscurations.
#pragma once

#include <cstddef>
#include <string>

namespace petzval {

/// A figure on a surface, in the surface's own x and y. Light passes inside it, or outside it where it is an
/// obscuration.
struct ApertureFigure {
  enum class Kind { ellipse, rectangle };
  Kind kind = Kind::ellipse;
  double half_width_x_mm = 0, half_width_y_mm = 0;  ///< half the axes; a circle has both alike
  double decentre_x_mm = 0, decentre_y_mm = 0;      ///< of its middle
  double rotation_deg = 0;                          ///< from +x towards +y
  bool obscures = false;

  bool operator==(const ApertureFigure&) const = default;

  /// How far a place is out of the middle, squared: 1 on the edge, 0 in the middle.
  double reach_sq(double x_mm, double y_mm) const;
  /// What of the two sides is closed: below 1 where light passes, above 1 where it does not.
  double share_sq(double x_mm, double y_mm) const;
  /// Whether it is the same all round the vertex.
  bool is_round() const;
  /// The same, turned about the vertex from +x towards +y [rad].
  ApertureFigure turned(double angle) const;
  /// Its mirror image x → −x.
  ApertureFigure mirrored() const;
  /// The farthest place of the figure from the vertex of the surface.
  double farthest_mm() const;
};

/// What is wrong with it, "half_width_x_mm must be …"; empty: nothing.
std::string aperture_figure_fault(const ApertureFigure& shape);

}  // namespace petzval
