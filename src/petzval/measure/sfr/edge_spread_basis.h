// SPDX-License-Identifier: BSD-3-Clause
// The functions whose sum is an edge-spread function, and the places of their coefficients.
#pragma once

#include <petzval/measure/sfr/edge_shapes.h>

#include <algorithm>
#include <array>
#include <cstddef>

namespace petzval {

/// Quintic B-splines within ±core come first, then the closed forms (dark, step and two tails), then the
/// shapes, which no sample touches, then light that varies.
struct EdgeSpreadBasis {
  static constexpr double scale_px = 1;   ///< of the closed forms
  static constexpr int support = 6;       ///< splines that cover an interval between knots
  static constexpr int closed_forms = 4;  ///< dark, step, tail1, tail3
  /// Terms of light that varies, to each order.
  static constexpr std::array<int, 3> light_terms = {0, 2, 5};

  /// Coefficients of 1, t, … t⁵ in the p-th of the quintic cardinal B-splines that cover an interval between
  /// knots, at a share t of it: Σ_k (−1)^k C(6, k) (x − k)₊^5/120 at x = t + 5 − p.
  static constexpr std::array<double, support> quintic(int p) {
    constexpr int pairs[support] = {1, 6, 15, 20, 15, 6}, powers[support] = {1, 5, 10, 10, 5, 1};
    std::array<double, support> coefficients{};
    for (int k = 0; k < support - p; ++k)
      for (int m = 0; m < support; ++m) {
        double product = k % 2 == 0 ? 1.0 : -1.0;
        for (int i = 0; i < support - 1 - m; ++i) product *= support - 1 - p - k;
        coefficients[static_cast<std::size_t>(m)] += product * pairs[k] * powers[m] / 120;
      }
    return coefficients;
  }

  int splines = 0;
  double knot_px = 0.25;
  int light_order = 0;
  int shapes = 0;  ///< unknowns of shapes

  /// The splines that lie within `core_px` whole.
  static int splines_within(double core_px, double knot_px) {
    return std::max(0, static_cast<int>(2 * core_px / knot_px) - (support - 1));
  }
  double core_px() const { return 0.5 * knot_px * (splines + support - 1); }

  int dark() const { return splines; }
  int step() const { return splines + 1; }
  int tail1() const { return splines + 2; }
  int tail3() const { return splines + 3; }
  int shape(int k) const { return splines + closed_forms + k; }
  /// Where the terms of the highest order begin.
  int first_highest_light() const {
    return light_terms[static_cast<std::size_t>(std::max(0, light_order - 1))];
  }
  int lights() const { return light_terms[static_cast<std::size_t>(light_order)]; }
  /// The functions that reach everywhere and that samples touch.
  int fixed() const { return closed_forms + lights(); }
  /// Of the i-th of those.
  int place(int form) const { return splines + form + (form < closed_forms ? 0 : shapes); }
  /// The unknowns that are no splines.
  int border() const { return fixed() + shapes; }
  int size() const { return splines + border(); }
};

}  // namespace petzval
