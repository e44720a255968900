// SPDX-License-Identifier: BSD-3-Clause
// Charts to print at a stated size, with marks by which a photograph of one tells where its edges stand.
#pragma once

#include <petzval/target/polygon.h>

#include <array>
#include <string>

namespace petzval {

/// A mark: a dark ring with a dark dot in it, all about one point. The dot of the first mark is the larger.
struct ChartMark {
  Vertex centre;  ///< [mm]
  double radius_mm = 0, hole_mm = 0, dot_mm = 0;

  /// Of the areas of hole and dot, over the whole disc's.
  static constexpr double hole_share = 0.5625, first_dot_share = 0.2025, dot_share = 0.0625;
};

/// Marks in the corners of a chart [mm from its upper left corner, x right, y down]: upper left, the first,
/// then upper right, lower right, lower left.
std::array<ChartMark, 4> chart_marks(double width_mm, double height_mm);

/// The figures of test_chart() between the marks, in mm. \throws InputError for a chart below 60 mm or beyond
/// 5 m a side, and as test_chart().
TargetScene printed_chart(const std::string& name, double width_mm, double height_mm);

/// A drawing of a scene in mm at its true size, levels encoded as sRGB.
std::string printed_chart_svg(const TargetScene& scene, double width_mm, double height_mm);

}  // namespace petzval
