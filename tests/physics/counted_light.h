// SPDX-License-Identifier: BSD-3-Clause
// The light of a wall at a place of the sensor, by counting rays.
#pragma once

#include <petzval/trace/tracer.h>

#include <cmath>

namespace petzval {

/// n'² ∬ dα dβ [sr] over the directions that reach the object from an image point (x, y), counted on an even
/// grid of `side` × `side` directions that knows of no pupil, within a cone of 45° about the sensor's normal.
inline double counted_light_sr(const Tracer& tracer, double x_mm, double y_mm, int side) {
  const double half = std::sqrt(0.5);
  RayBatch rays;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const double a = half * (2 * (i + 0.5) / side - 1), b = half * (2 * (j + 0.5) / side - 1);
      if (a * a + b * b < 0.9)
        rays.push_back(x_mm, y_mm, tracer.image_z_mm(), a, b, -std::sqrt(1 - a * a - b * b));
    }
  tracer.trace_backward(rays);
  double passed = 0;
  for (const RayStatus status : rays.status) passed += status == RayStatus::ok;
  return passed * std::pow(2 * half / side, 2) * std::pow(tracer.image_index(), 2);
}

}  // namespace petzval
