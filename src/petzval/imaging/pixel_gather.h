// SPDX-License-Identifier: BSD-3-Clause
// From the light of cells to that of pixels: photosite and optical low-pass filter.
#pragma once

#include <petzval/imaging/cell_plane.h>
#include <petzval/imaging/source_light.h>
#include <petzval/wave/photosite.h>

#include <vector>

namespace petzval {

/// What light has gone through on its way to the cells, beside the lens: the source filter, and the window of
/// the kernels unless there is no blur.
struct LightPath {
  SourceFilter source;
  bool window = true;

  /// Cells hold means over what they see, and no more.
  bool is_exact() const { return !window && source.parts == 1; }

  /// What the window leaves of a frequency [cycles a cell].
  double of_window(double frequency) const;
};

/// With what weights the cells in and about a pixel share in its value: Σ over terms of down[i] · across[j],
/// of sum 1. Some weights are negative: they give back what the light lost on its path.
struct PixelTaps {
  struct Term {
    std::vector<double> down, across;  ///< size() each
  };
  int cells = 1;  ///< S: along a side of a pixel
  int reach = 0;  ///< cells beyond the edge of the pixel
  std::vector<Term> terms{{{1}, {1}}};

  int size() const { return cells + 2 * reach; }
  /// What they pass at a frequency [cycles/pixel], without the path.
  double transform(double fx_cpp, double fy_cpp) const;
};

/// \throws InputError for another photosite than a rectangle or ellipse within the pixel.
void check_photosite(const Photosite& site);

/// PixelTaps::reach of the weights for a photosite. \param exact  cells hold means over what they see, and
/// nothing else happened to the light: of these a whole square pixel is the plain mean.
int taps_reach(const Photosite& site, int cells, bool exact);

/// The weights that stand for a photosite after a path: the best in the sense of least squares for edges at
/// all places, through a lens whose MTF is exp(−|f|) with f in cycles/pixel. They are found along either
/// axis; the dots of a filter are a product of such, an ellipse a sum of eight strips. \throws InputError as
/// check_photosite().
PixelTaps pixel_taps(const Photosite& site, int cells, const LightPath& path);

/// \param plane  S × S cells to a pixel and taps.reach more all around. \param wanted  rows of pixels; others
/// are dark. \returns the plane of pixels.
CellPlane gathered(CellPlane plane, const PixelTaps& taps, RowRange wanted = {});

}  // namespace petzval
