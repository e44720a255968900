// SPDX-License-Identifier: BSD-3-Clause
// Polygons as text.
#pragma once

#include <petzval/target/polygon.h>

#include <string>

namespace petzval {

/// Reads polygons: the number of corners, then x and y of each, as MTF Mapper writes them; any white space
/// between numbers. Beyond that:
///
///     # a comment, to the end of the line
///     ground 0.9          level of the ground, 0 black to 1 white (else 1)
///     level 0.25          of the polygons that follow (else 0)
///     4  10 10  50 10  50 50  10 50
///     hole 3  20 20  40 20  30 40      one more contour of the polygon before it
///     rule nonzero        outlines that follow may cross themselves: what they wind about is inside;
///                         evenodd: what they wind about an odd number of times; simple (else): they may not
///
/// A corner that repeats the one before it is dropped, as MTF Mapper drops it. \throws InputError with the
/// line for anything else, and for a file without polygons or with more than 10 million corners.
TargetScene read_polygon_file(const std::string& path);
/// The same from text. \param name  for messages.
TargetScene parse_polygons(const std::string& text, const std::string& name);

}  // namespace petzval
