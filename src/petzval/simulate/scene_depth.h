// SPDX-License-Identifier: BSD-3-Clause
// How far away is what a camera sees.
#pragma once

#include <petzval/render/film/pixel_window.h>
#include <petzval/simulate/render.h>

#include <array>
#include <vector>

namespace petzval {

/// Distances from the film along the camera's axis [m] of what the pixels of a window see through the middle
/// of the stop, where focus plays no part; infinite where nothing is seen. Row by row.
std::vector<double> depths_seen_m(const PreparedScene& scene, const render::PixelWindow& window);

/// Of one pixel (column, row). \throws InputError for a pixel outside of the picture.
double depth_of_pixel_m(const PreparedScene& scene, const std::array<double, 2>& pixel);

/// Distances in a zone that a gap parts, wider than what is sharp at once: two things stand in it.
struct TwoDepths {
  double near_m = 0, far_m = 0;  ///< of the middle pixels on either side
};
/// Nothing for a zone of one thing, or one whose depths go over into each other; a tenth of the pixels at
/// least is on either side. \param deep_m  what is sharp at once, from its near to its far end.
std::optional<TwoDepths> parted_depths(std::vector<double> depths_m, double deep_m);

}  // namespace petzval
