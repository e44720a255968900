// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/measure/sfr/edge_alignment.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace petzval {

EdgeProfile profile_along(const std::vector<EdgeSample>& samples, const EdgeLine& line) {
  std::vector<EdgeFrame::Place> places;
  places.reserve(samples.size());
  double reach = 0;
  const EdgeFrame frame(line);
  for (const EdgeSample& s : samples) {
    places.push_back(frame.at(s.x, s.y));
    reach = std::max(reach, std::abs(places.back().distance));
  }
  const int half = static_cast<int>(reach / 2) + 1;
  std::vector<int> count(2 * static_cast<std::size_t>(half) + 1);  // of cells two pixels wide
  const auto cell = [&](double d) {
    return static_cast<std::size_t>(half + static_cast<int>(std::lround(d / 2)));
  };
  for (const EdgeFrame::Place& place : places) ++count[cell(place.distance)];
  const auto middle = static_cast<std::size_t>(half);
  const int enough = std::max(4, count[middle] / 4);
  std::size_t first = middle, last = middle;
  while (first > 0 && count[first - 1] >= enough) --first;
  while (last + 1 < count.size() && count[last + 1] >= enough) ++last;
  EdgeProfile profile;
  profile.low = 2 * (static_cast<double>(first) - half) - 1;
  profile.high = 2 * (static_cast<double>(last) - half) + 1;
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (places[i].distance >= profile.low && places[i].distance <= profile.high) {
      profile.points.push_back({places[i].distance, samples[i].value, places[i].along, 0});
      profile.sample.push_back(i);
    }
  profile.variation.assign(profile.points.size(), 0.0);
  return profile;
}

void fit_logistic(EdgeProfile& profile, const EdgeGuess& guess) {
  const double step = guess.bright - guess.dark;
  profile.fitted.clear();
  for (const EdgePoint& point : profile.points) {
    const double share = 1 / (1 + std::exp(-point.distance / guess.scale_px));
    profile.fitted.push_back({guess.dark + step * share, step / guess.scale_px * share * (1 - share)});
  }
}

EdgeAlignment alignment(const EdgeProfile& profile, int order, double reach_px, double noise) {
  using Matrix =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, EdgeAlignment::most, EdgeAlignment::most>;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, EdgeAlignment::most, 1>;
  const Eigen::Index n = order + 1;
  Matrix normal = Matrix::Zero(n, n);
  Vector right = Vector::Zero(n), row(n);
  for (std::size_t i = 0; i < profile.points.size(); ++i) {
    const EdgePoint& point = profile.points[i];
    if (std::abs(point.distance) > reach_px) continue;
    const EdgeSpreadModel::ValueAndSlope& at = profile.fitted[i];
    double power = -at.slope;
    for (Eigen::Index k = 0; k < n; ++k, power *= point.along) row[k] = power;
    normal.noalias() += row * row.transpose();
    right += row * (point.value - profile.variation[i] - at.value);
  }
  normal.diagonal() *= 1 + 1e-12;
  const Eigen::LDLT<Matrix> ldlt(normal);
  const Vector change = ldlt.solve(right);
  if (!change.allFinite()) throw InputError("the edge is too short to tell its direction");
  EdgeAlignment result;
  result.order = order;
  for (Eigen::Index k = 0; k < n; ++k) {
    const Vector unit = ldlt.solve(Vector::Unit(n, k));
    result.change[k] = change[k];
    result.significance[k] =
        std::abs(change[k]) / std::max(1e-300, noise * std::sqrt(std::max(0.0, unit[k])));
  }
  return result;
}

double align(EdgeLine& line, const EdgeAlignment& alignment) {
  double shift = 0;
  for (int k = 1; k <= alignment.order; ++k) {
    line.bend[static_cast<std::size_t>(k - 1)] += alignment.change[k];
    shift += std::abs(alignment.change[k]);
  }
  return shift;
}

void turn_by_bend(EdgeLine& line) {
  if (line.bend.size() != 1) return;
  line.normal_rad -= std::atan(line.bend[0] / line.half_length);
  line.bend[0] = 0;
}

}  // namespace petzval
