// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/numeric/quadrature.h>

#include <cmath>
#include <utility>

namespace petzval {

namespace {

/// P_n(x) and P_n'(x).
std::pair<double, double> legendre(int n, double x) {
  double previous = 1, current = x;
  for (int k = 2; k <= n; ++k)
    previous = std::exchange(current, ((2 * k - 1) * x * current - (k - 1) * previous) / k);
  return {current, n * (x * current - previous) / (x * x - 1)};
}

}  // namespace

QuadratureRule gauss_legendre(int n, double from, double to) {
  if (n < 1) throw InputError("a Gauss-Legendre rule needs at least one node");
  QuadratureRule rule;
  rule.nodes.resize(static_cast<std::size_t>(n));
  rule.weights.resize(static_cast<std::size_t>(n));
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  for (int i = 0; i < (n + 1) / 2; ++i) {
    // Tricomi's first guess, then Newton; four steps reach rounding for any n.
    double x = 2 * i + 1 == n ? 0.0 : std::cos(pi * (i + 0.75) / (n + 0.5));
    for (int step = 0; step < 5 && x != 0; ++step) {
      const auto [value, slope] = legendre(n, x);
      x -= value / slope;
    }
    const double slope = n == 1 ? 1.0 : legendre(n, x).second;
    const double weight = 2 / ((1 - x * x) * slope * slope);
    const auto low = static_cast<std::size_t>(i), high = static_cast<std::size_t>(n - 1 - i);
    rule.nodes[low] = middle - half * x;
    rule.nodes[high] = middle + half * x;
    rule.weights[low] = rule.weights[high] = half * weight;
  }
  return rule;
}

}  // namespace petzval
