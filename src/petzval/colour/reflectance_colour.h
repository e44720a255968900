// SPDX-License-Identifier: BSD-3-Clause
// The colour that a reflectance has under a light.
#pragma once

#include <petzval/colour/display.h>
#include <petzval/colour/sigmoid_reflectance.h>
#include <petzval/colour/spectrum.h>

#include <array>
#include <vector>

namespace petzval {

/// What an eye that takes a light for white sees of surfaces under it: tristimulus values of light ×
/// reflectance at some bands (Observer::weights), adapted to display white (bradford_adaptation). A perfect
/// white has display white, exactly.
class ReflectanceColour {
 public:
  /// \param light  on any scale. \param bands_nm  strictly increasing; empty: 380 to 730 nm every 5 nm.
  /// \throws InputError for a light that no eye takes for white.
  explicit ReflectanceColour(const Spectrum& light, std::vector<double> bands_nm = {});
  static const ReflectanceColour& d65();

  LinearRgb operator()(const SigmoidReflectance& reflectance) const;
  /// The share of the light's luminance that the surface gives back, 0 to 1.
  double luminous_reflectance(const SigmoidReflectance& reflectance) const;

  /// XYZ relative to display white, and its derivative with respect to c0, c1 and c2.
  struct WithSlope {
    std::array<double, 3> xyz{};
    std::array<std::array<double, 3>, 3> slope{};  ///< [X, Y or Z][c0, c1 or c2]
  };
  WithSlope with_slope(double c0, double c1, double c2) const;

 private:
  /// Σ of weights times the reflectance.
  double weighted(const SigmoidReflectance& reflectance, const std::vector<double>& weights) const;

  /// Of each wavelength t of SigmoidReflectance, and what it adds to the colour and to luminance: in arrays
  /// whose last wavelengths, up to whole vectors, add nothing.
  std::vector<double> t_, x_, y_, z_, luminous_;
};

}  // namespace petzval
