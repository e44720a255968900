// SPDX-License-Identifier: BSD-3-Clause
// A smooth reflectance of three numbers.
#pragma once

#include <cmath>

namespace petzval {

/// Reflectance s(c2 + c1 t + c0 t²) with s(x) = ½ + x / (2 √(1 + x²)) and t = (λ − 380 nm) / 350 nm: smooth,
/// and between 0 and 1 at every wavelength, so that no surface gives back more light than it gets. (Jakob &
/// Hanika, "A low-dimensional function space for efficient spectral upsampling", Eurographics 2019.)
struct SigmoidReflectance {
  static constexpr double first_nm = 380, range_nm = 350;

  double c0 = 0, c1 = 0, c2 = 0;

  double at(double wavelength_nm) const {
    const double t = (wavelength_nm - first_nm) / range_nm;
    if (c0 == 0 && c1 == 0) return sigmoid(c2);  // c2 of black and white is infinite
    return sigmoid(c2 + t * (c1 + t * c0));
  }

  /// s(x); x may be infinite.
  static double sigmoid(double x) {
    if (std::isinf(x)) return x > 0 ? 1 : 0;
    return 0.5 + x / (2 * std::sqrt(1 + x * x));
  }
};

}  // namespace petzval
