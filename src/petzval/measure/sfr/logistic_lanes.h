// SPDX-License-Identifier: BSD-3-Clause
// A logistic edge over many samples, on whatever SIMD the machine has.
#pragma once

#include <array>
#include <vector>

namespace petzval {

/// Samples to which a logistic edge is fitted; behind them zeros up to a multiple of eight.
struct LogisticSamples {
  std::vector<double> x, y, value;
  std::vector<double> weight;  ///< 1 for samples
};

/// Offset from the origin along the normal, its direction [rad], log of the scale, dark and bright level.
using LogisticEdge = std::array<double, 5>;

/// Σ residual², the lower half of the normal equations, row by row, and their right side.
struct LogisticSums {
  double square = 0;
  std::array<double, 15> normal{};
  std::array<double, 5> right{};
};
LogisticSums logistic_sums(const LogisticSamples& samples, const LogisticEdge& edge);

}  // namespace petzval
