// SPDX-License-Identifier: BSD-3-Clause
// What a target is made of: polygons with grey levels on a ground.
#pragma once

#include <petzval/scene/shape.h>

#include <string>
#include <vector>

namespace petzval {

/// A place in the picture [pixels]: x right, y down, pixel centres at half-integers.
using Vertex = Point;
using Contour = std::vector<Vertex>;  ///< closed: the last vertex is joined to the first

/// One area of one level. A place is inside if a ray from it crosses the contours an odd number of times, so
/// that a contour within another is a hole. Neither direction matters.
struct Polygon {
  std::vector<Contour> contours;
  double level = 0;
  int line = 0;  ///< of the file that it comes from, for messages; 0: none
};

/// Later polygons cover earlier ones. Levels are relative irradiance: 0 is black, 1 is white.
struct TargetScene {
  double ground = 1;
  std::vector<Polygon> polygons;
  std::string source;  ///< file, for messages
};

/// Half-planes and anything else may reach as far as this from the frame [pixels]; farther is an error.
inline constexpr double target_reach_px = 2e7;

/// Twice the area is Σ (a.x b.y − b.x a.y); positive where x → y turns as on paper with y up.
double signed_area(const Contour& contour);

/// A rectangle about a centre, its width turned from the x axis towards +y (clockwise in the picture) by an
/// angle. \throws InputError unless the sizes are positive and finite.
Contour rectangle(Vertex centre, double width, double height, double angle_deg);

/// The half-plane to the side of `through` at which direction `angle_deg` (from +x towards +y) points, as a
/// square so large that its other sides do not matter (1e-8 of the contrast).
Contour half_plane(Vertex through, double angle_deg);

/// A regular polygon or, with many corners, a disc. \throws InputError for fewer than three corners.
Contour regular_polygon(Vertex centre, double radius, int corners, double angle_deg);

/// \throws InputError at the first polygon that is none: fewer than three different corners, no area, numbers
/// that are not finite or out of reach, levels that are not finite, or contours that cross themselves or each
/// other. The message names the file, the line and the edges.
void validate(const TargetScene& scene);

}  // namespace petzval
