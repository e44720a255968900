// SPDX-License-Identifier: BSD-3-Clause
// How many cells a pixel needs, by the scene's own detail and the lens.
#pragma once

#include <petzval/imaging/image_formation.h>

#include <vector>

namespace petzval {

/// What of a scene's contrast is how fine: one band of it.
struct DetailSpectrum {
  double mean = 0;
  /// The variance within squares of 2, 4, 8 … samples that is not within those of half the side.
  std::vector<double> variances;
};
DetailSpectrum detail_of(const Scene& scene, int band);

/// The relative L2 error of a picture whose pixels are so many cells wide, whatever the blur method: detail
/// that cells cannot hold, and kernels' samples that mistake one frequency for another.
///
/// \param samples_per_pixel  of the scene, along a side. \param mtf  of the lens over cycles/pixel.
double sampling_error(const DetailSpectrum& detail, double samples_per_pixel, const Photosite& site,
                      int cells, const LightPath& path, const std::function<double(double)>& mtf);

/// How many cells a pixel gets, and the sampling_error() that they leave.
struct CellChoice {
  int cells = 1;
  double error = 0;
};

/// The cells that the options name; else the fewest whose sampling_error(), in the scene's middle band and
/// through the table's MTF, RMS over the frame, is within half of the tolerance: 2 at least, but for
/// tolerances of 3·10⁻³ and more, and 8 at most.
CellChoice choose_cells(const Scene& scene, const LensDataTable& table, const SensorGeometry& sensor,
                        const ImagingOptions& options);

}  // namespace petzval
