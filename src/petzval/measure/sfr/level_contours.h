// SPDX-License-Identifier: BSD-3-Clause
// Lines of equal value through a picture.
#pragma once

#include <petzval/measure/sfr/edge_samples.h>

#include <vector>

namespace petzval {

struct ContourPoint {
  double x = 0, y = 0;  ///< [pixels], centres at half-integers
};

/// A line along which the bright side lies to the left of the way it runs, seen with x to the right and y up
/// (to the right in the picture, where y runs down).
struct LevelContour {
  std::vector<ContourPoint> points;
  bool closed = false;  ///< else it ends at the rim of the picture
};

/// The level halfway between the means of the dark and bright pixels, parted so that the variance between
/// them is greatest (Otsu, IEEE Trans. SMC 9 (1979) 62).
double halfway_level(const Plane& plane);

/// Contours at a level, linear between pixel centres (marching squares), of at least `least_points` points;
/// saddle points are parted by the mean of their four pixels.
std::vector<LevelContour> level_contours(const Plane& plane, double level, std::size_t least_points);

}  // namespace petzval
