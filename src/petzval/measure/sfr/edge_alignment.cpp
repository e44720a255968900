// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/unset_vector.h>
#include <petzval/measure/sfr/edge_alignment.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

namespace petzval {

EdgeProfile profile_along(const std::vector<EdgeSample>& samples, const EdgeLine& line) {
  EdgeProfile profile;
  profile.points.reserve(samples.size());
  double reach = 0;
  const EdgeFrame frame(line);
  for (const EdgeSample& sample : samples) {
    const EdgeFrame::Place place = frame.at(sample.x, sample.y);
    profile.points.push_back({place.distance, sample.value, place.along, 0});
    reach = std::max(reach, std::abs(place.distance));
  }
  const int half = static_cast<int>(reach / 2) + 1;
  std::vector<int> count(2 * static_cast<std::size_t>(half) + 1);  // of cells two pixels wide
  for (const EdgePoint& point : profile.points)
    ++count[static_cast<std::size_t>(static_cast<int>(half + 0.5 + 0.5 * point.distance))];
  const auto middle = static_cast<std::size_t>(half);
  const int enough = std::max(4, count[middle] / 4);
  std::size_t first = middle, last = middle;
  while (first > 0 && count[first - 1] >= enough) --first;
  while (last + 1 < count.size() && count[last + 1] >= enough) ++last;
  profile.low = 2 * (static_cast<double>(first) - half) - 1;
  profile.high = 2 * (static_cast<double>(last) - half) + 1;
  profile.sample.resize(samples.size());
  std::size_t points = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const EdgePoint& point = profile.points[i];
    if (point.distance < profile.low || point.distance > profile.high) continue;
    profile.points[points] = point;
    profile.sample[points++] = i;
  }
  profile.points.resize(points);
  profile.sample.resize(points);
  profile.variation.assign(points, 0.0);
  return profile;
}

void fit_logistic(EdgeProfile& profile, const EdgeGuess& guess, double reach_px) {
  const double step = guess.bright - guess.dark;
  profile.fitted.assign(profile.points.size(), {});
  for (std::size_t i = 0; i < profile.points.size(); ++i) {
    const double distance = profile.points[i].distance;
    if (std::abs(distance) > reach_px) continue;
    const double share = 1 / (1 + std::exp(-distance / guess.scale_px));
    profile.fitted[i] = {guess.dark + step * share, step / guess.scale_px * share * (1 - share)};
  }
}

namespace {

/// Normal equations of offset, direction and bends.
template <int terms>
struct AlignmentSums {
  Eigen::Matrix<double, terms, terms> normal = decltype(normal)::Zero();
  Eigen::Matrix<double, terms, 1> right = decltype(right)::Zero();

  /// \returns derivatives of the value at a point.
  std::array<double, terms> add(const EdgeProfile& profile, std::size_t i, int order) {
    const EdgePoint& point = profile.points[i];
    const EdgeSpreadModel::ValueAndSlope& at = profile.fitted[i];
    const double residual = point.value - profile.variation[i] - at.value;
    std::array<double, terms> row{};
    double power = -at.slope;
    for (int k = 0; k <= order; ++k, power *= point.along) {
      row[static_cast<std::size_t>(k)] = power;
      right[k] += power * residual;
      for (int j = 0; j <= k; ++j) normal(k, j) += power * row[static_cast<std::size_t>(j)];
    }
    return row;
  }
};

/// \param first  of the terms that are free.
template <int terms>
EdgeAlignment solved(const AlignmentSums<terms>& sums, int first, int order, double noise) {
  const int n = order + 1 - first;
  Eigen::MatrixXd normal = sums.normal.block(first, first, n, n).template selfadjointView<Eigen::Lower>();
  const Eigen::VectorXd right = sums.right.segment(first, n);
  const Eigen::LDLT<Eigen::MatrixXd> ldlt(normal);
  const Eigen::VectorXd change = ldlt.solve(right);
  if (!change.allFinite()) throw InputError("the edge is too short to tell its direction");
  EdgeAlignment result;
  result.order = order;
  for (int k = 0; k < n; ++k) {
    const double variance = ldlt.solve(Eigen::VectorXd::Unit(n, k))[k];
    result.change[first + k] = change[k];
    result.deviation[first + k] = noise * std::sqrt(std::max(0.0, variance));
  }
  return result;
}

constexpr int most_terms = BorderedBand::lanes;

template <int terms>
EdgeAlignment with_free_profile(const EdgeProfile& profile, const EdgeSpreadModel& model, int order,
                                double noise) {
  AlignmentSums<terms> sums;
  UnsetVector<double> derivatives(profile.points.size() * terms);
  auto at = derivatives.begin();
  for (std::size_t i = 0; i < profile.points.size(); ++i, at += terms)
    if (std::abs(profile.points[i].distance) <= model.core_px())
      std::ranges::copy(sums.add(profile, i, order), at);
    else
      std::fill_n(at, terms, 0.0);
  // What little is left along the pixel grid must not be lost to rounding.
  const Eigen::VectorXd alone = sums.normal.diagonal();
  sums.normal -= model.taken_of<terms>(derivatives);
  sums.normal.diagonal() += 1e-9 * alone;
  return solved(sums, 1, order, noise);
}

}  // namespace

EdgeAlignment alignment(const EdgeProfile& profile, int order, double reach_px, double noise) {
  AlignmentSums<most_terms> sums;
  for (std::size_t i = 0; i < profile.points.size(); ++i)
    if (std::abs(profile.points[i].distance) <= reach_px) sums.add(profile, i, order);
  sums.normal.diagonal() *= 1 + 1e-12;
  return solved(sums, 0, order, noise);
}

EdgeAlignment alignment(const EdgeProfile& profile, const EdgeSpreadModel& model, int order, double noise) {
  if (order < 2) return with_free_profile<2>(profile, model, order, noise);
  if (order < 4) return with_free_profile<4>(profile, model, order, noise);
  return with_free_profile<most_terms>(profile, model, order, noise);
}

double shift_of(const EdgeAlignment& alignment) {
  double shift = 0;
  for (int k = 1; k <= alignment.order; ++k) shift += std::abs(alignment.change[k]);
  return shift;
}

double align(EdgeLine& line, const EdgeAlignment& alignment, double length) {
  for (int k = 1; k <= alignment.order; ++k)
    line.bend[static_cast<std::size_t>(k - 1)] += length * alignment.change[k];
  return length * shift_of(alignment);
}

void turn_by_bend(EdgeLine& line) {
  if (line.bend.size() != 1) return;
  line.normal_rad -= std::atan(line.bend[0] / line.half_length);
  line.bend[0] = 0;
}

}  // namespace petzval
