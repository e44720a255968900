// SPDX-License-Identifier: BSD-3-Clause
// From poses to frames and back, for files that state places in other ways than Petzval does.
#pragma once

#include <petzval/lens/pose.h>

namespace petzval {

/// Where a vertex at the origin stands after a pose.
Frame frame_of(const Pose& pose);
/// The pose that makes a frame of it. Of the two that do, the one with a tilt about y within 90 degrees.
Pose pose_of(const Frame& frame);
/// `inner` stated in the axes of `outer`.
Frame composed(const Frame& outer, const Frame& inner);
Frame inverse(const Frame& frame);
/// Whether two frames differ by less than rounding leaves of files: 1e-11 mm, and 1e-13 of a direction.
bool is_as_good_as_none(const Frame& frame);

}  // namespace petzval
