// SPDX-License-Identifier: BSD-3-Clause
// What a photosite and an optical low-pass filter do to spatial frequencies.
#pragma once

#include <complex>
#include <string>
#include <utility>
#include <vector>

namespace petzval {

/// The sensitive area of a photosite, evenly sensitive, in pixels about the pixel's centre; and a four-dot
/// optical low-pass filter before it.
struct Photosite {
  enum class Shape {
    none,       ///< a point: the irradiance at the pixel's centre
    rectangle,  ///< width × height
    ellipse,    ///< of these full axes
    polygon     ///< vertices (x right, y down), without crossings; need not be centred
  };
  Shape shape = Shape::rectangle;
  double width = 1, height = 1;
  std::vector<std::pair<double, double>> vertices;
  /// The four dots stand at (±separation_x/2, ±separation_y/2); 0: no filter along that axis.
  double separation_x = 0, separation_y = 0;

  static Photosite square(double fill_factor = 1);  ///< sides √fill_factor

  /// Whether it is the whole square pixel, without a filter.
  bool is_plain() const;
  /// "box", "point", or in one line what it is: the aperture that a file of irradiance states.
  std::string text() const;
  bool operator==(const Photosite&) const = default;

  /// \throws InputError for sizes that are not positive or above 100 pixels, or a polygon of no area.
  void validate() const;
  /// At a frequency [cycles/pixel]; 1 at frequency zero.
  std::complex<double> transform(double fx_cpp, double fy_cpp) const;
  /// Whether the transform is that at (fx, 0) times that at (0, fy).
  bool is_separable() const { return shape == Shape::none || shape == Shape::rectangle; }
};

/// sin(πx)/(πx).
double sinc(double x);

}  // namespace petzval
