// SPDX-License-Identifier: BSD-3-Clause
// A smooth function of the place about an edge, by interpolation.
#pragma once

#include <petzval/measure/sfr/chebyshev_lanes.h>
#include <petzval/measure/sfr/edge_line.h>

#include <Eigen/Core>
#include <functional>
#include <span>
#include <vector>

namespace petzval {

/// Distances from an edge between which samples lie [pixels].
struct DistanceRange {
  double low = 0, high = 0;
};

/// A polynomial in the places along an edge and across it through a function's values at Chebyshev nodes (L.
/// N. Trefethen, Approximation Theory and Approximation Practice, SIAM 2013, chapter 3), as a sum of
/// Chebyshev polynomials. Beyond the range it is that of the nearest place within.
class SmoothAboutEdge {
 public:
  struct Nodes {
    int along = 13, across = 11;
  };
  static constexpr int most_along = 13, most_across = ChebyshevTerms::most_across;
  SmoothAboutEdge(const std::function<double(double x, double y)>& function, const EdgeLine& line,
                  DistanceRange range, Nodes nodes);
  double operator()(double x, double y) const;
  /// The same at each of the samples.
  std::vector<double> at(std::span<const EdgeSample> samples) const;

 private:
  EdgeLine line_;  ///< without its bend
  double cos_, sin_, middle_, per_half_;
  Nodes nodes_;  ///< and as many polynomials that are not nearly nothing
  void at(std::span<const double> along, std::span<const double> across, std::span<double> values) const;
  using Across = Eigen::Array<double, most_across, 1>;
  std::vector<Across> coefficients_;  ///< of each polynomial along
};

}  // namespace petzval
