// SPDX-License-Identifier: BSD-3-Clause
// The edge-spread function of an unbounded straight edge, in closed form up to one integral.
#pragma once

#include <petzval/base/units.h>
#include <petzval/numeric/quadrature.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace petzval::test {

/// ½ + (1/π) ∫₀^ν_c T(ν) sin(2πνd)/ν dν: the picture of the half-plane d > 0 (level 1) at a distance d from
/// its edge, T the real transfer function along the normal. Composite Gauss-Legendre.
inline double edge_spread(const std::function<double(double)>& transfer, double cutoff, double d) {
  const int pieces = 40 + static_cast<int>(4 * cutoff * std::abs(d));
  static const QuadratureRule rule = gauss_legendre(16);
  double sum = 0;
  for (int p = 0; p < pieces; ++p)
    for (std::size_t j = 0; j < rule.nodes.size(); ++j) {
      // ν = ν_c (1 − u²) takes the 3/2 power out of the end.
      const double u = (p + rule.nodes[j]) / pieces, nu = cutoff * (1 - u * u);
      sum += rule.weights[j] / pieces * 2 * u * cutoff * transfer(nu) * std::sin(2 * pi * nu * d) / nu;
    }
  return 0.5 + sum / pi;
}

/// The diffraction OTF of a defocused clear pupil, by a quadrature of its own: (4/π) ∫ sin²θ cos(8πW s (cos θ
/// − s)) dθ from 0 to acos s (Hopkins 1955).
inline double defocus_otf(double s, double w020) {
  if (s >= 1) return 0;
  if (w020 == 0) return 2 / pi * (std::acos(s) - s * std::sqrt(1 - s * s));
  static const QuadratureRule rule = gauss_legendre(120);
  double sum = 0;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    const double theta = std::acos(s) * rule.nodes[i];
    sum += rule.weights[i] * std::sin(theta) * std::sin(theta) *
           std::cos(8 * pi * w020 * s * (std::cos(theta) - s));
  }
  return 4 / pi * std::acos(s) * sum;
}

inline double sinc_of(double x) {
  return x == 0 ? 1 : std::sin(pi * x) / (pi * x);
}

}  // namespace petzval::test
