// SPDX-License-Identifier: BSD-3-Clause
// A smooth reflectance for every colour that a display can show.
#pragma once

#include <petzval/colour/display.h>
#include <petzval/colour/reflectance_colour.h>
#include <petzval/colour/sigmoid_reflectance.h>

#include <array>
#include <vector>

namespace petzval {

/// The reflectance that has this linear sRGB colour under a light, by Gauss-Newton on the difference in
/// CIELAB; a grey is constant over wavelength, exactly. Components are clamped to [0, 1]. Colours within 1e-3
/// of the gamut's corners are met as nearly as the sigmoid can (about one unit of ΔE under D65).
SigmoidReflectance reflectance_of(LinearRgb colour,
                                  const ReflectanceColour& under = ReflectanceColour::d65());

/// reflectance_of() by interpolation in a table, for pictures: about 30 ns a pixel instead of some ten µs.
///
///     const ReflectanceTable table;                    // a second of one core
///     const double r = table(pixel).at(550);
///
/// Immutable; may be shared between threads.
class ReflectanceTable {
 public:
  /// \param under  must outlive the table.
  explicit ReflectanceTable(const ReflectanceColour& under = ReflectanceColour::d65());
  SigmoidReflectance operator()(LinearRgb colour) const;
  /// The same followed by as many steps of the fit as bring it to a tenth of a step of an 8-bit picture,
  /// four at most: some µs a pixel.
  SigmoidReflectance refined(LinearRgb colour) const;

 private:
  static constexpr int nodes = 32;
  const SigmoidReflectance& node(int largest, int level, int first, int second) const;

  const ReflectanceColour& under_;
  std::array<double, nodes> levels_{};
  std::vector<SigmoidReflectance> nodes_;
};

}  // namespace petzval
