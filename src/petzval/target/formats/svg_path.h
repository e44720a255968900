// SPDX-License-Identifier: BSD-3-Clause
// The data of an SVG path as contours.
#pragma once

#include <petzval/target/polygon.h>

#include <array>
#include <string_view>
#include <vector>

namespace petzval {

/// (x, y) → (a x + c y + e, b x + d y + f).
struct SvgTransform {
  double a = 1, b = 0, c = 0, d = 1, e = 0, f = 0;
  Vertex operator()(Vertex v) const { return {a * v.x + c * v.y + e, b * v.x + d * v.y + f}; }
  SvgTransform operator*(const SvgTransform& inner) const;
};

/// "translate(3 4) rotate(5)" and so on. \throws InputError.
SvgTransform parse_svg_transform(std::string_view text);

/// All commands of SVG 1.1, section 8.3; every subpath must be closed (Z, or back at its start). Curves are
/// divided into chords within `tolerance` pixels after the transform. \throws InputError saying what is wrong
/// at which character.
std::vector<Contour> parse_svg_path(std::string_view data, const SvgTransform& transform,
                                    double tolerance = 1e-4);

}  // namespace petzval
