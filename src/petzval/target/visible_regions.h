// SPDX-License-Identifier: BSD-3-Clause
// What remains to be seen of polygons that cover each other.
#pragma once

#include <petzval/target/polygon.h>

#include <vector>

namespace petzval {

/// A part of the scene by its directed outline: every contour runs so that the inside has a positive signed
/// area, holes run the other way. `step` is its level above the ground.
struct Region {
  std::vector<Contour> contours;
  double step = 0;
};

/// The scene as regions that do not overlap: scene = ground + Σ step over each region. Polygons that no later
/// one overlaps keep their corners exactly; the others are cut (Vatti's algorithm, the Clipper library),
/// which rounds corners to 2^-24 of a pixel.
std::vector<Region> visible_regions(const TargetScene& scene);

/// What is inside contours that cross: where they wind about a place at all, or an odd number of times.
enum class FillRule { nonzero, evenodd };

/// The same area, of contours that may cross, as parts whose contours do not, each an outline and its holes.
/// Corners are rounded as by visible_regions. \throws InputError for corners that are not finite or out of
/// reach.
std::vector<std::vector<Contour>> simple_parts(const std::vector<Contour>& contours, FillRule rule);

/// Whether anything of the polygons lies within a picture of this size.
bool meets_frame(const TargetScene& scene, int columns, int rows);

/// The part of a contour inside a box, as one contour; where the box is left it runs along its border
/// (Sutherland & Hodgman, Commun. ACM 17 (1974) 32). Empty if nothing is inside.
Contour clip_to_box(const Contour& contour, Vertex low, Vertex high);

}  // namespace petzval
