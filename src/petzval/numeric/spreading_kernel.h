// SPDX-License-Identifier: BSD-3-Clause
// The kernel that spreads point masses over a grid, and its transform.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace petzval {

/// φ(u) = exp(β(√(1 − (2u/w)²) − 1)) for |u| ≤ w/2 grid cells, w = 14, β for a grid 1.5 times as fine as
/// needed (Barnett, Magland & af Klinteberg 2019, eq. 1.8 and section 3.2). By polynomials, one a cell, to
/// 1e-13.
class SpreadingKernel {
 public:
  static constexpr int width = 14;
  static constexpr double oversampling = 1.5;
  static constexpr int lanes = 16;  ///< width rounded up to full vectors
  static constexpr int degree = 15;

  SpreadingKernel();

  /// φ at the `width` grid points from `first` on, where first − position = −width/2 + offset, 0 ≤ offset
  /// < 1.
  void values(double offset, double* out) const {
    for (int i = 0; i < lanes; ++i) out[i] = coefficients_[degree][static_cast<std::size_t>(i)];
    const double t = 2 * offset - 1;
    for (int power = degree - 1; power >= 0; --power)
      for (int i = 0; i < lanes; ++i)
        out[i] = out[i] * t + coefficients_[static_cast<std::size_t>(power)][static_cast<std::size_t>(i)];
  }

  /// Of that power of 2 · offset − 1, `lanes` of them: those of values().
  const double* coefficients(int power) const {
    return coefficients_[static_cast<std::size_t>(power)].data();
  }

  /// 1/φ̂ at frequencies 0 … highest of a grid of `size` cells.
  std::vector<double> correction(int highest, int size) const;

 private:
  std::array<std::array<double, lanes>, degree + 1> coefficients_{};  ///< [power of t][grid point]
};

/// The one kernel, made at first use.
const SpreadingKernel& spreading_kernel();

/// The grid on which frequencies up to `highest` are made.
int spreading_grid_size(int highest);

}  // namespace petzval
