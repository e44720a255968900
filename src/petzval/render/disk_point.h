// SPDX-License-Identifier: BSD-3-Clause
// Points spread evenly over a disk.
#pragma once

#include <petzval/base/units.h>

#include <cmath>

namespace petzval::render {

struct DiskPoint {
  double x, y;
};

/// Cosine and sine of an angle from −π/4 to π/4: their series, to the rounding of a double.
inline DiskPoint unit_circle(double angle) {
  const double t = angle * angle;
  const auto sum = [t](double one, double two, double three, double four, double five, double six,
                       double seven, double eight) {
    // Products of their own first, so that they need not wait for each other.
    const double t2 = t * t, t4 = t2 * t2;
    return (one + two * t) + (three + four * t) * t2 + ((five + six * t) + (seven + eight * t) * t2) * t4;
  };
  const double cos = 1 - t * sum(1.0 / 2, -1.0 / 24, 1.0 / 720, -1.0 / 40320, 1.0 / 3628800, -1.0 / 479001600,
                                 1.0 / 87178291200, -1.0 / 20922789888000);
  const double sin = angle - angle * t *
                                 sum(1.0 / 6, -1.0 / 120, 1.0 / 5040, -1.0 / 362880, 1.0 / 39916800,
                                     -1.0 / 6227020800, 1.0 / 1307674368000, 0);
  return {cos, sin};
}

/// A point of the unit disk for two numbers in [0, 1); even, and neighbours stay neighbours (Shirley & Chiu
/// 1997).
inline DiskPoint disk_point(double u, double v) {
  const double a = 2 * u - 1, b = 2 * v - 1;
  if (a == 0 && b == 0) return {0, 0};
  const bool wide = std::abs(a) > std::abs(b);
  const double r = wide ? a : b;
  const DiskPoint on = unit_circle(pi / 4 * (wide ? b / a : a / b));
  return wide ? DiskPoint{r * on.x, r * on.y} : DiskPoint{r * on.y, r * on.x};
}

}  // namespace petzval::render
