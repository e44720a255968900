// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/measure/sfr/stated_deviations.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace petzval {

namespace {

/// A mean of so many squares may be noise up to this many of its standard errors. A single square is a
/// chi-square of one degree of freedom, which has a long tail.
double shown_from(int count) {
  return 1 + 5 / std::sqrt(count);
}

bool shows(const DeviationParts& parts, std::size_t i) {
  return parts.model_square[i] > shown_from(1) * std::sqrt(parts.square_variance[i]);
}

/// What edges show together that none of them shows.
class Hidden {
 public:
  /// \param sign  1, or −1 for one that was added before.
  void add(const DeviationParts& parts, int sign) {
    sums_.resize(std::max(sums_.size(), parts.model_square.size()));
    for (std::size_t i = 0; i < parts.model_square.size(); ++i) {
      if (shows(parts, i)) continue;
      sums_[i].count += sign;
      sums_[i].corners2 += sign * parts.corners * parts.corners;
      sums_[i].square += sign * parts.model_square[i];
      sums_[i].variance += sign * parts.square_variance[i];
    }
  }
  /// The part of one of them.
  double square_of(const DeviationParts& parts, std::size_t i) const {
    const Sums& sums = sums_[i];
    if (!(sums.square > shown_from(sums.count) * std::sqrt(std::max(0.0, sums.variance)))) return 0;
    return sums.square * parts.corners * parts.corners / sums.corners2;
  }

 private:
  struct Sums {
    int count = 0;
    double corners2 = 0, square = 0, variance = 0;
  };
  std::vector<Sums> sums_;
};

void state(EdgeMeasurement& edge, const Hidden* hidden) {
  const DeviationParts& parts = edge.parts;
  const auto deviation = [&](std::size_t i) {
    const double own = parts.without_noise ? std::max(0.0, parts.model_square[i])
                       : shows(parts, i)   ? parts.model_square[i]
                       : hidden != nullptr ? hidden->square_of(parts, i)
                                           : 0;
    return std::sqrt(parts.of_samples[i] * parts.of_samples[i] + own);
  };
  const std::size_t frequencies = edge.frequencies_cpp.size();
  edge.sfr_deviation.clear();
  for (std::size_t i = 0; i < frequencies; ++i) edge.sfr_deviation.push_back(deviation(i));
  std::size_t passed = 0;
  for (MtfLevel& level : edge.mtf) {
    level.deviation_cpp = NAN;
    if (!std::isfinite(level.frequency_cpp)) continue;
    level.deviation_cpp = deviation(frequencies + passed) * parts.level_run[passed];
    ++passed;
  }
}

}  // namespace

void state_deviations(std::span<EdgeMeasurement* const> edges) {
  std::vector<EdgeMeasurement*> telling;
  for (EdgeMeasurement* edge : edges)
    if (edge->parts.corners > 0 && !edge->parts.without_noise)
      telling.push_back(edge);
    else
      state(*edge, nullptr);
  std::ranges::sort(telling, {}, [](const EdgeMeasurement* edge) { return edge->rise_px; });
  constexpr double alike = 1.1;
  Hidden near;
  std::size_t first = 0, last = 0;
  for (EdgeMeasurement* edge : telling) {
    for (; last < telling.size() && telling[last]->rise_px <= alike * edge->rise_px; ++last)
      near.add(telling[last]->parts, 1);
    for (; telling[first]->rise_px * alike < edge->rise_px; ++first) near.add(telling[first]->parts, -1);
    state(*edge, &near);
  }
}

}  // namespace petzval
