// SPDX-License-Identifier: BSD-3-Clause
// A smooth reflectance for every colour that a display can show.
#pragma once

#include <petzval/colour/display.h>

#include <array>
#include <vector>

namespace petzval {

/// Reflectance s(c2 + c1 t + c0 t²) with s(x) = ½ + x / (2 √(1 + x²)) and t = (λ − 380 nm) / 350 nm: smooth,
/// and between 0 and 1 at every wavelength, so that no surface gives back more light than it gets. (Jakob &
/// Hanika, "A low-dimensional function space for efficient spectral upsampling", Eurographics 2019.)
struct SigmoidReflectance {
  double c0 = 0, c1 = 0, c2 = 0;

  double at(double wavelength_nm) const;
};

/// The reflectance that has this linear sRGB colour under D65, by Gauss-Newton on the difference in CIELAB; a
/// grey is constant over wavelength, exactly. Components are clamped to [0, 1]. Colours within 1e-3 of the
/// gamut's corners are met as nearly as the sigmoid can (about one unit of ΔE).
SigmoidReflectance reflectance_of(LinearRgb colour);

/// reflectance_of() by interpolation in a table, for pictures: about 30 ns a pixel instead of some ten µs.
///
///     const ReflectanceTable table;                    // a second of one core
///     const double r = table(pixel).at(550);
///
/// Immutable; may be shared between threads.
class ReflectanceTable {
 public:
  ReflectanceTable();
  SigmoidReflectance operator()(LinearRgb colour) const;

 private:
  static constexpr int nodes = 32;
  const SigmoidReflectance& node(int largest, int level, int first, int second) const;

  std::array<double, nodes> levels_{};
  std::vector<SigmoidReflectance> nodes_;
};

}  // namespace petzval
