// SPDX-License-Identifier: BSD-3-Clause
// The edge-based SFR as common tools compute it, for comparison with them.
#pragma once

#include <petzval/measure/sfr/edge_samples.h>

#include <vector>

namespace petzval {

/// What is done, step by step: the centroid of each row's difference [−½, ½] under a Hamming window about the
/// row's middle and then about the fitted line; a straight line through the centroids; pixels averaged in
/// bins of a quarter of a pixel across the line; the central difference [−½, 0, ½]; a Hamming window; the
/// modulus of the transform over its value at zero; times min(10, (2πk/N)/sin(2πk/N)), the correction that
/// belongs to this difference, and 1/cos θ on frequencies. It tapers the tail of the profile and keeps the
/// box of a bin: the exact method does neither. It follows published descriptions of the slanted-edge method
/// of ISO 12233 (Burns, PICS 2000, 135); no claim is made to the letter of any edition of the standard.
struct IsoEsfr {
  double angle_deg = 0;  ///< of the edge from the nearer axis, −45 to 45, clockwise in the picture
  std::vector<double> frequencies_cpp, sfr;  ///< up to 1 cycle/pixel
  double mtf50_cpp = 0;                      ///< NaN if the SFR stays above one half
};

/// \throws InputError as samples_in, when rows have no edge, or fewer than 16 rows or columns are given.
IsoEsfr iso_esfr(const Plane& plane, const PixelBox& box);

}  // namespace petzval
