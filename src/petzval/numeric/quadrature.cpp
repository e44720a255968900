// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/numeric/quadrature.h>

#include <cmath>
#include <cstddef>
#include <map>
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

/// The rule on [−1, 1], of which the half x ≥ 0 says everything, the largest x first.
QuadratureRule half_rule(int n) {
  QuadratureRule rule;
  for (int i = 0; i < (n + 1) / 2; ++i) {
    // Tricomi's first guess, then Newton; four steps reach rounding for any n.
    double x = 2 * i + 1 == n ? 0.0 : std::cos(pi * (i + 0.75) / (n + 0.5));
    for (int step = 0; step < 5 && x != 0; ++step) {
      const auto [value, slope] = legendre(n, x);
      x -= value / slope;
    }
    const double slope = n == 1 ? 1.0 : legendre(n, x).second;
    rule.nodes.push_back(x);
    rule.weights.push_back(2 / ((1 - x * x) * slope * slope));
  }
  return rule;
}

/// Each thread makes a rule once: a pupil with blades asks for six of them and more.
const QuadratureRule& known_half_rule(int n) {
  constexpr std::size_t most_rules = 256;
  thread_local std::map<int, QuadratureRule> rules;
  const auto found = rules.find(n);
  if (found != rules.end()) return found->second;
  if (rules.size() == most_rules) rules.clear();
  return rules.emplace(n, half_rule(n)).first->second;
}

}  // namespace

QuadratureRule gauss_legendre(int n, double from, double to) {
  if (n < 1) throw InputError("a Gauss-Legendre rule needs at least one node");
  const QuadratureRule& half_of = known_half_rule(n);
  QuadratureRule rule;
  rule.nodes.resize(static_cast<std::size_t>(n));
  rule.weights.resize(static_cast<std::size_t>(n));
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  for (std::size_t low = 0; low < half_of.nodes.size(); ++low) {
    const std::size_t high = static_cast<std::size_t>(n) - 1 - low;
    rule.nodes[low] = middle - half * half_of.nodes[low];
    rule.nodes[high] = middle + half * half_of.nodes[low];
    rule.weights[low] = rule.weights[high] = half * half_of.weights[low];
  }
  return rule;
}

}  // namespace petzval
