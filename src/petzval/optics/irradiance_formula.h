// SPDX-License-Identifier: BSD-3-Clause
// The irradiance that f-number and magnification promise, to compare with what rays bring.
#pragma once

#include <petzval/base/units.h>

#include <cmath>

namespace petzval {

/// Irradiance on the axis under a uniform wall, per radiance [sr], as ISETCam's oiCalculateIrradiance reckons
/// it (Catrysse, dissertation, Stanford 2003): π / (1 + 4 N² (1 + |m|)²). With θ the marginal ray's angle it
/// is π sin²θ for tan θ = 1/(2N(1 + |m|)): a lens without losses and without pupil aberration, whose pupils
/// are of one size. ISETCam enters the f-number *at the object distance* for N, which has (1 + |m|) in it
/// already.
inline double iset_irradiance_sr(double f_number, double magnification) {
  const double n = f_number * (1 + std::abs(magnification));
  return pi / (1 + 4 * n * n);
}

}  // namespace petzval
