// SPDX-License-Identifier: BSD-3-Clause
// Samples by their distance from a line, and how to turn and bend the line so that they agree.
#pragma once

#include <petzval/measure/sfr/edge_spread_model.h>
#include <petzval/measure/sfr/measure_edge.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace petzval {

/// Samples by distance from a line; those beyond the range in which every distance is well covered are left
/// out.
struct EdgeProfile {
  std::vector<EdgePoint> points;
  std::vector<std::size_t> sample;                     ///< of each point
  std::vector<double> variation;                       ///< what does not belong to the profile at each point
  std::vector<EdgeSpreadModel::ValueAndSlope> fitted;  ///< of the profile at each point
  double low = 0, high = 0;
};

/// From the edge outwards as long as a pixel's width of distances holds a quarter of what it holds at the
/// edge.
EdgeProfile profile_along(const std::vector<EdgeSample>& samples, const EdgeLine& line);

/// Takes the logistic profile of the guess for the fitted one, as far as `reach_px` from the edge.
void fit_logistic(EdgeProfile& profile, const EdgeGuess& guess, double reach_px);

/// What a Gauss-Newton step would do to direction and bends.
struct EdgeAlignment {
  static constexpr int most = 6;
  int order = 1;
  double change[most] = {};     ///< of bend[k − 1] for k = 1 … order; 0 is an offset, left to the profile
  double deviation[most] = {};  ///< standard deviation of each
  double significance(int k) const { return std::abs(change[k]) / std::max(1e-300, deviation[k]); }
};

/// Residual ≈ −E′(d) ∂d/∂p δp over points no farther than `reach_px`, the profile as it is but for an offset.
/// \param noise  standard deviation of the values.
/// \throws InputError for an edge too short to tell its direction.
EdgeAlignment alignment(const EdgeProfile& profile, int order, double reach_px, double noise);
/// The same, with a profile that follows.
EdgeAlignment alignment(const EdgeProfile& profile, const EdgeSpreadModel& model, int order, double noise);
/// The largest shift of the line anywhere [pixels].
double shift_of(const EdgeAlignment& alignment);
/// Takes the step, or `length` of it. \returns its shift.
double align(EdgeLine& line, const EdgeAlignment& alignment, double length);

/// A straight bend belongs to the direction, so that distances are exact.
void turn_by_bend(EdgeLine& line);

}  // namespace petzval
