// SPDX-License-Identifier: BSD-3-Clause
// From the light of cells to that of pixels: photosite and optical low-pass filter.
#pragma once

#include <petzval/imaging/cell_plane.h>
#include <petzval/wave/photosite.h>

#include <vector>

namespace petzval {

/// With what weights the cells in and about a pixel share in its value: (cells + 2·reach)² of sum 1,
/// row-major, none negative.
struct PixelTaps {
  int cells = 1;  ///< S: along a side of a pixel
  int reach = 0;  ///< cells beyond the edge of the pixel
  std::vector<double> weights{1};

  int size() const { return cells + 2 * reach; }
  /// What they pass at a frequency [cycles/pixel], with `boxes` means over a cell before them.
  double transform(double fx_cpp, double fy_cpp, int boxes) const;
};

/// Taps that stand for a photosite together with `boxes` means over a cell that the light has gone through
/// already: that of the source cell (if the scene is finer than it) and that of the receiving one. They are
/// the area shares of the cells under a shape whose size is such that the variance of everything is the
/// photosite's; the four dots of the filter are linear between cells, and that is made good too. One box
/// alone tiles a whole square pixel exactly. \param site  rectangle or ellipse within the pixel. \throws
/// InputError for another.
PixelTaps pixel_taps(const Photosite& site, int cells, int boxes);

/// The smallest number of cells along a pixel, from `least` to 16, whose taps pass what the photosite does to
/// 0.01 at every frequency up to Nyquist's; `least` for a whole square pixel without a filter.
int cells_for(const Photosite& site, int boxes, int least);

/// \param plane  S × S cells to a pixel and taps.reach more all around. \returns the plane of pixels.
CellPlane gathered(CellPlane plane, const PixelTaps& taps);

}  // namespace petzval
