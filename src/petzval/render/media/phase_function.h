// SPDX-License-Identifier: BSD-3-Clause
// Where a medium scatters light to.
#pragma once

#include <petzval/base/units.h>
#include <petzval/render/vector3.h>

#include <algorithm>
#include <cmath>

namespace petzval::render {

/// Henyey and Greenstein's phase function (Astrophys. J. 93 (1941) 70) [1/sr]; integrates to 1 over the
/// sphere.
/// \param cos  between the light's way before and after. \param g  mean of that cosine, within (−1, 1):
/// positive scatters forwards.
inline double henyey_greenstein(double cos, double g) {
  const double base = 1 + g * g - 2 * g * cos;
  return (1 - g * g) / (4 * pi * base * std::sqrt(base));
}

/// A direction of that density about the way of the light.
/// \param way  unit. \param u, v  in [0, 1).
inline Vector3 sample_henyey_greenstein(Vector3 way, double g, double u, double v) {
  constexpr double nearly_even = 1e-4;  // below it the inverse cancels, and the error is smaller than this
  double cos = 1 - 2 * u;
  if (std::abs(g) > nearly_even) {
    const double root = (1 - g * g) / (1 + g - 2 * g * u);
    cos = std::clamp((1 + g * g - root * root) / (2 * g), -1.0, 1.0);
  }
  const double sin = std::sqrt(1 - cos * cos), phi = 2 * pi * v;
  return Frame(way).from_local({sin * std::cos(phi), sin * std::sin(phi), cos});
}

}  // namespace petzval::render
