// SPDX-License-Identifier: BSD-3-Clause
// The paraxial matrices of a lens, the two halves on either side of its stop.
#pragma once

#include <petzval/lens/lens.h>

namespace petzval {

/// Takes (height, index × slope) of a paraxial ray from one plane to another: (a y + b w, c y + d w),
/// determinant 1. (Kingslake & Johnson, Lens Design Fundamentals, 2nd ed. 2010, ch. 3.)
struct ParaxialMatrix {
  double a = 1, b = 0, c = 0, d = 1;

  double height(double y, double w) const { return a * y + b * w; }
  double reduced_slope(double y, double w) const { return c * y + d * w; }
  void refract(double power_per_mm);
  void transfer(double reduced_distance_mm);
};

/// A lens at one wavelength. A grating counts as its zeroth order. Mirrors are unfolded: all is counted along
/// the light.
struct ParaxialSystem {
  ParaxialMatrix whole;      ///< from vertex 1 (in front of it) to the last vertex (behind it)
  ParaxialMatrix to_stop;    ///< from vertex 1 to the vertex of the stop surface, in front of it
  ParaxialMatrix from_stop;  ///< from the vertex of the stop surface to the last vertex (behind it)
  double object_index = 1, image_index = 1;
  double petzval_sum_per_mm = 0;  ///< Σ φ/(n n'), without the factor n of the image space
};

/// \throws InputError when an index is not known at the wavelength.
ParaxialSystem paraxial_system(const Lens& lens, double wavelength_nm);

}  // namespace petzval
