// SPDX-License-Identifier: BSD-3-Clause
// Letters made of straight strokes, for charts.
#pragma once

#include <petzval/scene/shape.h>

#include <string_view>
#include <vector>

namespace petzval {

/// Adds letters, figures and . , : = + - _ / % @ ( ) [ ] to a shape; other characters leave a gap.
/// \param left, top  corner of the first letter's box. \param height  of capitals, strokes included.
void add_text(Shape& shape, std::string_view text, double left, double top, double height);
/// The same as outlines, one a stroke.
void add_text(std::vector<std::vector<Point>>& outlines, std::string_view text, double left, double top,
              double height);

/// How far small letters such as p reach below the box of capitals of this height.
double text_descent(double height);

/// Width of a text from the left of its first letter's box to the right of its last one's.
double text_width(std::string_view text, double height);

}  // namespace petzval
