// SPDX-License-Identifier: BSD-3-Clause
// What is sharp in front of a camera, and how deep.
#pragma once

#include <petzval/lens/lens.h>

namespace petzval {

/// The nearest and the farthest object that is still sharp, from the sensor plane [m]; far may be infinite.
struct DepthOfField {
  double near_m = 0, far_m = 0;
};

/// The objects whose images lie so far behind and before that of the lens's object, by paraxial optics.
DepthOfField depth_of_field(const Lens& lens, double behind_mm, double before_mm);

/// The objects whose cones of light are at most one pixel wide on the sensor: from the exit pupil (width D, L
/// before the sensor) a cone is c wide c L/(D ∓ c) behind or before its tip. The lens's object is in focus.
DepthOfField geometric_depth_of_field(const Lens& lens, double pixel_mm);

/// The object that is sharp on the sensor where it stands [m from the sensor], by paraxial optics; infinite
/// where the sensor stands before the focus of infinity. \param shift_mm  by which the sensor stands behind
/// the paraxial image of what is sharp: of a best focus.
double distance_in_focus_m(const Lens& lens, double shift_mm = 0);

}  // namespace petzval
