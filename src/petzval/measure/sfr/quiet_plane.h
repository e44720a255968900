// SPDX-License-Identifier: BSD-3-Clause
// A picture smoothed as its noise asks for.
#pragma once

#include <petzval/measure/sfr/edge_samples.h>

#include <optional>

namespace petzval {

/// The standard deviation of the noise, over the range of the values: from how far pixels lie from the mean
/// of their neighbours to the left and right.
double noise_share(const Plane& plane);

/// What contours are drawn through where there is noise of half a hundredth of the contrast or more: the
/// plane, smoothed. Absent: the plane as it is. \param share  noise_share() of it.
std::optional<Plane> quiet(const Plane& plane, double share);

}  // namespace petzval
