// SPDX-License-Identifier: BSD-3-Clause
// Polygons from the shapes of an SVG drawing.
#pragma once

#include <petzval/target/polygon.h>

#include <string>

namespace petzval {

/// Reads <path>, <polygon>, <rect>, <circle> and <ellipse>, within groups and with transforms. A user unit is
/// a pixel. Curves become chords within 1e-4 pixels of them. The level is the luminance of the fill (#rgb,
/// #rrggbb, black, white, grey, rgb(…)), 0 to 1 in linear light; shapes with fill "none" are left out;
/// strokes, text and style sheets are no outlines and are refused where they would be seen. Later shapes
/// cover earlier ones; holes follow the even-odd rule, or the non-zero rule where fill-rule does not say
/// otherwise. \throws InputError for damaged XML or path data, naming the element.
TargetScene read_svg_shapes(const std::string& path);
TargetScene parse_svg_shapes(const std::string& text, const std::string& name);

}  // namespace petzval
