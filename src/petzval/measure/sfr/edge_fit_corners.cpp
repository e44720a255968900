// SPDX-License-Identifier: BSD-3-Clause
// What corners add to a fitted edge, and the fits of its other samples and splines that tell how much.
#include <petzval/measure/sfr/edge_fit.h>
#include <petzval/measure/sfr/sample_comb.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

namespace petzval {

/// How far along the edge samples may lie that a blur does not reach from a corner.
double EdgeFit::clear_of_corners() const {
  double farthest = INFINITY;
  for (const ContourPoint& corner : corners_)
    farthest = std::min(farthest, std::abs(line_.along(corner.x, corner.y)));
  return farthest - reach_of_blur_px() / line_.half_length;
}

/// Samples with hardly any noise can be spared where a wide blur reaches them from a corner.
void EdgeFit::keep_clear_of_corners() {
  constexpr double hardly_any = 3e-4, least_along = 0.4;
  const double clear = clear_of_corners();
  if (clear >= 1 || noise_ > hardly_any * model_->step()) return;
  EdgeProfile all = std::move(profile_);
  most_along_ = std::max(clear, least_along);
  place_samples();
  if (comb_px_ > 0) join_rows(profile_.points);
  if (!close_enough(profile_.points, all.points)) {
    most_along_ = 1;
    profile_ = std::move(all);
    return;
  }
  // Where only a little was cut off, the difference tells nothing of what is left.
  constexpr double enough = 1.5;
  if (const double added = added_by_corners(all.points) / added_by_corners(profile_.points); added > enough)
    near_corners_.push_back(
        {std::move(*model_),
         static_cast<double>(all.points.size()) / static_cast<double>(profile_.points.size()), added});
  model_.reset();
  smoothing_ = -1;
  fit_profile();
}

/// Parts of the samples may leave gaps as wide as knots are apart, or hardly wider than those of all.
bool EdgeFit::close_enough(const std::vector<EdgePoint>& part, const std::vector<EdgePoint>& all) const {
  constexpr double hardly = 1.05;
  const double gap_px = widest_gap_px(part);
  return gap_px <= model_->options().knot_px || gap_px <= hardly * widest_gap_px(all);
}

/// In proportion to what corners add to a profile of these points. Of light that goes as r⁻³ the profile
/// knows; what is left falls faster by another square or so, r⁻⁵, of which the part beyond a corner is its
/// distance to the power of minus three.
double EdgeFit::added_by_corners(const std::vector<EdgePoint>& points) const {
  const double reach = reach_of_blur_px();
  double sum = 0;
  std::size_t within = 0;
  for (const ContourPoint& corner : corners_) {
    const double end = line_.along(corner.x, corner.y);
    for (const EdgePoint& point : points) {
      if (std::abs(point.distance) > reach) continue;
      const double along = line_.half_length * (end - point.along);
      const double square = std::max(1.0, along * along + point.distance * point.distance);
      sum += 1 / (square * std::sqrt(square));
      ++within;
    }
  }
  return sum / static_cast<double>(within);
}

double EdgeFit::reach_of_blur_px() const {
  constexpr double rises = 2;
  return rises * 4.39 * guess_.scale_px;
}

std::vector<EdgeFit::Variant> EdgeFit::variants() const {
  std::vector<Variant> result = near_corners_;
  constexpr double much_noise = 3e-3;  // of the step, in which what a halo adds from afar is lost
  if (noise_ > much_noise * model_->step() && clear_of_corners() >= 1) return result;
  for (const double most_along : {0.4, 0.6, 0.8, 1.0}) {
    std::vector<EdgePoint> inner;
    std::ranges::copy_if(profile_.points, std::back_inserter(inner), [&](const EdgePoint& point) {
      return std::abs(point.along) <= most_along * most_along_;
    });
    if (most_along < 1 && !close_enough(inner, profile_.points)) continue;
    EdgeSpreadOptions options = model_->options();
    if (without_noise()) {
      options.core_px *= 0.85;
      if (!in_rows_) options.knot_px *= 0.8;
      options.prior.noise = noise_, options.smoothing = 0;
    }
    const bool tells = most_along < 1 && !corners_.empty();
    result.push_back({EdgeSpreadModel(inner, options),
                      static_cast<double>(inner.size()) / static_cast<double>(profile_.points.size()),
                      tells ? added_by_corners(inner) / added_by_corners(profile_.points) : 0});
    break;
  }
  return result;
}

}  // namespace petzval
