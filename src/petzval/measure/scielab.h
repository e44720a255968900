// SPDX-License-Identifier: BSD-3-Clause
// Differences between pictures as an eye at a distance sees them.
#pragma once

#include <petzval/measure/viewed_picture.h>

#include <vector>

namespace petzval {

struct ScielabDifference {
  int columns = 0, rows = 0;
  std::vector<float> delta_e;  ///< ΔE*ab of each pixel
  double mean = 0, percentile_95 = 0, max = 0;
};

/// Pixels a degree of visual angle, for a display seen from a distance.
double pixels_per_degree(double distance_mm, double pixel_pitch_um);

/// S-CIELAB (Zhang & Wandell, "A spatial extension of CIELAB for digital color-image reproduction", J. SID 5
/// (1997) 61): both pictures are turned into the opponent channels of Poirson & Wandell, each channel is
/// blurred by the sum of Gaussians of its visibility, and the ΔE*ab of the results is taken pixel by pixel.
/// Pictures are
/// mirrored at their edges. \throws InputError unless the pictures have one size, and for
/// resolutions below 4 or above 1000 pixels a degree.
ScielabDifference scielab(const ViewedPicture& a, const ViewedPicture& b, double pixels_per_degree);

}  // namespace petzval
