// SPDX-License-Identifier: BSD-3-Clause
// Fields that a file gives as points in x and y.
#pragma once

namespace petzval {

/// On a lens that is round only the distance of a field point from the axis counts; the sign of y is kept
/// where x is 0. \param is_angle  x and y are angles in degrees, of planes through the axis; else heights.
double radial_field(double x, double y, bool is_angle);

}  // namespace petzval
