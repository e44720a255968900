// SPDX-License-Identifier: BSD-3-Clause
// A smooth function of the place about an edge, by interpolation.
#pragma once

#include <petzval/measure/sfr/edge_line.h>

#include <functional>
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
  static constexpr int most_nodes = 13;
  SmoothAboutEdge(const std::function<double(double x, double y)>& function, const EdgeLine& line,
                  DistanceRange range, Nodes nodes);
  double operator()(double x, double y) const;

 private:
  EdgeLine line_;  ///< without its bend
  double cos_, sin_, middle_, per_half_;
  Nodes nodes_;
  std::vector<double> coefficients_;  ///< those along next to each other
  int used_along_[most_nodes] = {};   ///< of each across; the others are nearly nothing
};

}  // namespace petzval
