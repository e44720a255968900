// SPDX-License-Identifier: BSD-3-Clause
// A picture smoothed as its noise asks for.
#pragma once

#include <petzval/measure/sfr/edge_samples.h>

namespace petzval {

/// What contours are drawn through: with noise of a hundredth of the contrast and more, smoothed.
Plane quiet(const Plane& plane);

}  // namespace petzval
