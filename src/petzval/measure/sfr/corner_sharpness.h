// SPDX-License-Identifier: BSD-3-Clause
// What the four corners of a picture say about the lens it was taken with.
#pragma once

#include <petzval/measure/sfr/frame_sharpness.h>

#include <array>
#include <optional>

namespace petzval {

/// MTF50 in the corners [cycles/pixel]: the mean of all edges, of every direction, whose middle lies within
/// half of the half diagonal from the corner, the surer ones counting more. NaN where there is none.
struct CornerSharpness {
  std::array<double, 4> mtf50_cpp{};  ///< top left, top right, bottom left, bottom right
  double least_cpp = 0;               ///< of the four; NaN if one is
  double symmetry = 0;                ///< the least over the largest
  /// How far red or blue lies from green along an edge in the corners, root mean square [pixels]; nothing
  /// without colours.
  std::optional<double> colour_px;
};

/// \param edges  of one channel: of several, those of green. \param columns, rows  of the picture.
CornerSharpness corner_sharpness(std::span<const MeasuredEdge> edges, int columns, int rows);

}  // namespace petzval
