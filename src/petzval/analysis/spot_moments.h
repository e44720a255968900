// SPDX-License-Identifier: BSD-3-Clause
// What a sum over the rays of a spot says of it, wherever along the axis the sensor stands.
#pragma once

#include <petzval/analysis/field_tracer.h>
#include <petzval/analysis/pupil_rays.h>
#include <petzval/analysis/spots.h>

#include <span>
#include <vector>

namespace petzval {

/// Weighted means over the rays of one field and wavelength: places r (from the axis) on the image surface
/// and slopes s = (α, β)/γ. In x both have the mean zero where rays stand for their mirror images.
struct SpotMoments {
  double field = 0, wavelength_nm = 0;
  double x = 0, y = 0, slope_x = 0, slope_y = 0;
  double r_r = 0, r_slope = 0, slope_slope = 0;  ///< of products, x and y together

  /// Of the spread about the mean place, on a sensor so far behind the image surface [mm²].
  double variance(double shift_mm) const;
};

SpotMoments spot_moments(const std::vector<PupilRay>& rays, const ChiefRay& chief, RayWeight weight);
/// Several spots as one, their shares summing to 1.
SpotMoments mixed(std::span<const SpotMoments> spots, const std::vector<double>& shares);
/// The shift at which the variances sum to the least: −Σ cov(r, s)/Σ var(s).
double best_shift_mm(std::span<const SpotMoments> spots);

}  // namespace petzval
