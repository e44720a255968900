// SPDX-License-Identifier: BSD-3-Clause
// Where a lens images the crossings of a square grid.
#pragma once

#include <petzval/analysis/tv_distortion.h>

#include <vector>

namespace petzval {

/// Crossings of lines × lines, row by row from the top of the image surface, left to right (x′, y′ in mm).
struct DistortionGrid {
  int lines = 0;
  double wavelength_nm = 0;
  std::vector<double> ideal_x_mm, ideal_y_mm;  ///< evenly over the frame
  std::vector<double> x_mm, y_mm;              ///< of the chief rays; NaN where none arrives

  /// The largest distance of a crossing from its ideal place, over the frame's half diagonal.
  double largest_share() const;
};

/// The grid is one of a plane object perpendicular to the axis (tangents of field angles for an object at
/// infinity). A lens without distortion images it as it images the middle of the frame, by the derivative of
/// chief rays there: that is the ideal place, also of a lens with poses. Chief rays decide, whatever clips
/// others. \param lines  at least 3, odd. \throws InputError for other numbers, for a frame without size, and
/// where no chief ray reaches the middle.
DistortionGrid distortion_grid(const Lens& lens, const FrameSize& frame, double wavelength_nm,
                               int lines = 13);

}  // namespace petzval
