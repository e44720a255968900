// SPDX-License-Identifier: BSD-3-Clause
// Level contours of a picture as corners joined by straight lines.
#pragma once

#include <petzval/measure/sfr/level_contours.h>

#include <cstddef>
#include <vector>

namespace petzval {

/// A straight piece of an outline, the bright side to the same hand all along.
struct OutlineSide {
  ContourPoint from, to;
};

/// One outline of a target, as corners joined by straight lines.
struct TargetOutline {
  std::vector<ContourPoint> corners;
  bool closed = false;
  std::size_t sides() const { return corners.size() - (closed ? 0 : 1); }
  OutlineSide side(std::size_t s) const {
    return {corners[s % corners.size()], corners[(s + 1) % corners.size()]};
  }
};

/// Sides first … first + count − 1 of an outline, which go on into each other without a corner.
struct Stretch {
  std::size_t first = 0, count = 1;
};

/// The corners of a contour, so that the lines between them stay within the tolerance [pixels] (Ramer 1972;
/// Douglas & Peucker 1973), and are where lines through the middles of neighbouring sides meet.
std::vector<ContourPoint> straightened(const LevelContour& contour, double tolerance);

/// All of an outline's sides. Those that meet at less than 8°, and turn by less than 25° in all, are one
/// stretch.
std::vector<Stretch> stretches_of(const TargetOutline& outline);

}  // namespace petzval
