// SPDX-License-Identifier: BSD-3-Clause
// A minimum between two places, without derivatives.
#pragma once

#include <optional>

namespace petzval {

/// A place and its cost.
struct Tried {
  double x, cost;
};

/// Brent's search (Algorithms for Minimization without Derivatives, 1973, ch. 5) between two ends, starting
/// from three places already tried: the best, and the ends of its bracket. It is told what is tried, by
/// itself or by others.
class BrentSearch {
 public:
  BrentSearch(Tried low, Tried best, Tried high);

  /// The next place worth trying; nothing when the best is known to `tolerance`.
  std::optional<double> next(double tolerance);
  void add(Tried tried);
  bool brackets(double x) const { return x > low_ && x < high_; }
  double low() const { return low_; }
  double high() const { return high_; }

 private:
  /// From the best to the vertex of the parabola through the best three; false if it has none.
  bool parabola(double& step) const;

  double low_, high_;
  Tried best_, second_, third_;
  double last_step_, step_before_;
};

}  // namespace petzval
