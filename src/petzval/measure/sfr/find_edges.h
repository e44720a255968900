// SPDX-License-Identifier: BSD-3-Clause
// Straight edges in a picture, and what stands around them.
#pragma once

#include <petzval/measure/sfr/edge_line.h>
#include <petzval/measure/sfr/level_contours.h>
#include <petzval/measure/sfr/outlines.h>

#include <memory>
#include <vector>

namespace petzval {

/// A stretch of an outline without corners, straight or bent a little.
struct FoundEdge {
  ContourPoint from, to;       ///< its ends, at the corners
  bool corner_at_from = true;  ///< false: it runs out of the picture there
  bool corner_at_to = true;
  double reach_dark_px = 0, reach_bright_px = 0;  ///< free of other edges so far on either side
  /// Where samples are taken, from the middle of the edge towards `to` [pixels].
  double sampled_from = 0, sampled_to = 0;
  std::vector<OutlineSide> neighbours;  ///< all other sides that are near enough to matter
  double length_px() const;
  /// The line from end to end, its normal from dark to bright.
  EdgeLine line() const;
};

struct FoundEdges {
  std::vector<FoundEdge> edges;
};

struct EdgeSearchOptions {
  double least_length_px = 30;
  double greatest_reach_px = 80;  ///< how far from an edge samples are taken
  double tolerance_px = 0.75;     ///< within which an outline is straight
  /// Of an arc that has a chord of the least length within the tolerance: without noise, those of less are no
  /// edges.
  constexpr double least_radius_px() const { return least_length_px * least_length_px / (8 * tolerance_px); }
};

/// Edges of rectangles, checkerboards, stars and anything else that stands out by its brightness: contours at
/// the level halfway between dark and bright of the picture, smoothed as its noise asks for, divided into
/// straight lines (Ramer 1972; Douglas & Peucker 1973). Lines that meet at less than 8°
/// are one edge. Edges of blurred targets have rounded corners; what is rounded is left out. The time grows
/// with the pixels and the sides of the outlines. \throws InputError if there is no edge.
FoundEdges find_edges(const Plane& plane, const EdgeSearchOptions& options = {});

/// The samples about a found edge: as far along it as corners do not disturb it, and as far to both sides as
/// it is free.
std::vector<EdgeSample> samples_about(const Plane& plane, const FoundEdge& edge,
                                      const PixelLattice& lattice = {});

/// The found edge that runs through samples like a measured line; nothing if none does within 2 pixels and 2
/// degrees.
const FoundEdge* edge_along(const FoundEdges& found, const EdgeLine& line);

}  // namespace petzval
