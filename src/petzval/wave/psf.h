// SPDX-License-Identifier: BSD-3-Clause
// A point-spread function on a grid of its own.
#pragma once

#include <cstddef>
#include <vector>

namespace petzval {

/// The image of one object point in one wavelength: size × size samples at a spacing of its own, centred on
/// the real chief ray (sample [size/2][size/2], integer division) and summing to 1; radiometry lives in
/// g_source and g_sensor. Sample [i][j] (row-major) sits at
///     s = (j − size/2)·spacing, the sagittal direction,
///     t = (i − size/2)·spacing, the tangential direction, positive away from the optical axis.
/// With the chief-ray image point at (0, +h) in image space, s = +x' and t = +y' of the real (inverted)
/// image; at any other azimuth the pair is rotated rigidly about the axis.
struct Psf {
  int size = 0;
  double spacing_um = 0;
  std::vector<float> values;  ///< size·size, row-major, sum 1
  /// The share of the light that fell inside the window before the samples were normalised to sum 1.
  double captured = 1;

  float at(int i, int j) const {
    return values[static_cast<std::size_t>(i) * static_cast<std::size_t>(size) + static_cast<std::size_t>(j)];
  }
  /// Distance from the centre to the edge of the outermost sample [µm].
  double half_width_um() const { return 0.5 * size * spacing_um; }
};

}  // namespace petzval
