// SPDX-License-Identifier: BSD-3-Clause
// Lettering as polygons.
#pragma once

#include <petzval/target/polygon.h>

#include <string>
#include <vector>

namespace petzval {

/// Letters of straight strokes 2/15 as wide as the capitals are high, drawn for this program: A to Z, digits
/// and . , : ; - + = / ( ) ' ! ? and blanks. Small letters are small capitals, three quarters as high.
struct TextStyle {
  double height_px = 20;  ///< of capitals, from the middle of a stroke to the middle of a stroke
  double angle_deg = 0;   ///< of the line of writing, from +x towards +y
  double level = 0;
};

/// Distance from the beginning of the first letter to the end of the last [pixels]. \throws as text_polygons.
double text_width(const std::string& text, const TextStyle& style);

/// One polygon a stroke (some overlap, all of one level), the upper left corner of the first letter at
/// `corner`. \throws InputError for a character that has no shape, naming it, text without any stroke, or a
/// height that is not positive or beyond target_reach_px.
std::vector<Polygon> text_polygons(const std::string& text, Vertex corner, const TextStyle& style);

}  // namespace petzval
