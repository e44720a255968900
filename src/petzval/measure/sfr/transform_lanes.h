// SPDX-License-Identifier: BSD-3-Clause
// Fourier sums over splines at eight frequencies at once, on whatever SIMD the machine has.
#pragma once

#include <array>

namespace petzval {

/// cos and sin of 2πf times the place of the outermost spline, and of 2πf times their distance.
struct SplinePhases {
  static constexpr int count = 8;
  std::array<double, count> cosine, sine, turn_cosine, turn_sine;
};

/// Σ_j c_j cos(φ_j) and Σ_j c_j sin(φ_j), where φ grows from spline to spline by the turn and is odd about
/// the middle of all.
struct SplineSums {
  std::array<double, SplinePhases::count> even, odd;
};
SplineSums spline_sums(const SplinePhases& phases, const double* coefficients, int splines);

/// The same backwards: rows of eight, for each spline even · cos(φ_j) + odd · sin(φ_j).
void spline_waves(const SplinePhases& phases, const SplineSums& factors, int splines, double* rows);

}  // namespace petzval
