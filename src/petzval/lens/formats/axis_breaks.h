// SPDX-License-Identifier: BSD-3-Clause
// Files that turn the axis: from one surface on all that follows stands in new axes. Petzval states it as
// groups that reach up to the sensor.
#pragma once

#include <petzval/lens/frame_pose.h>
#include <petzval/lens/lens.h>

#include <cstddef>
#include <vector>

namespace petzval {

/// In front of a surface (the number of surfaces: the sensor) the axes become those of a frame.
struct AxisBreak {
  std::size_t surface = 0;
  Frame frame = {};
  double pivot_mm = 0;  ///< where, along the axis from that surface
};

/// \param breaks  in the order of the light.
void put_axis_breaks(const std::vector<AxisBreak>& breaks, Lens& lens);

/// The breaks that a lens with poses wants, one in front of each surface that does not stand on the axis of
/// the one before. `gap_shift_mm[i]`, along the axis behind surface i − 1, belongs to its gap.
struct AxisBreaks {
  std::vector<AxisBreak> breaks;     ///< decentres within the plane, and tilts
  std::vector<double> gap_shift_mm;  ///< in front of each surface, and of the sensor
};
AxisBreaks axis_breaks_of(const Lens& lens);

}  // namespace petzval
