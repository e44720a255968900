// SPDX-License-Identifier: BSD-3-Clause
// Where the places of a printed chart lie in its photograph.
#pragma once

#include <petzval/measure/sfr/edge_line.h>
#include <petzval/measure/sfr/edge_samples.h>

#include <Eigen/Core>
#include <array>

namespace petzval {

/// A flat chart seen in perspective: places on the chart [mm from its upper left corner, x right, y down] and
/// in the picture [pixels] by a homography. Distortion of the lens is not a part of it.
class ChartMapping {
 public:
  /// By the four marks of chart_marks(), which are looked for in the picture. \throws InputError for
  /// sizes that are not positive, and where not all of them are seen.
  ChartMapping(const Plane& plane, double width_mm, double height_mm);

  /// \returns x and y on the chart [mm].
  std::array<double, 2> on_chart(double x_px, double y_px) const;
  /// Cycles per mm on the chart, across an edge, for each cycle per pixel across it in the picture.
  double per_mm(const EdgeLine& edge) const;

 private:
  /// Derivatives of the picture's coordinates by the chart's, at a place of the chart.
  Eigen::Matrix2d pixels_per_mm(double x_mm, double y_mm) const;

  Eigen::Matrix3d picture_of_chart_, chart_of_picture_;
};

}  // namespace petzval
