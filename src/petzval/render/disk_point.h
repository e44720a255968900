// SPDX-License-Identifier: BSD-3-Clause
// Points spread evenly over a disk.
#pragma once

#include <petzval/base/units.h>

#include <cmath>

namespace petzval::render {

struct DiskPoint {
  double x, y;
};

/// A point of the unit disk for two numbers in [0, 1); even, and neighbours stay neighbours (Shirley & Chiu
/// 1997).
inline DiskPoint disk_point(double u, double v) {
  const double a = 2 * u - 1, b = 2 * v - 1;
  if (a == 0 && b == 0) return {0, 0};
  const bool wide = std::abs(a) > std::abs(b);
  const double r = wide ? a : b, phi = wide ? pi / 4 * (b / a) : pi / 2 - pi / 4 * (a / b);
  return {r * std::cos(phi), r * std::sin(phi)};
}

}  // namespace petzval::render
