// SPDX-License-Identifier: BSD-3-Clause
// How many cells a pixel needs, by the scene's own detail and the lens.
#pragma once

#include <petzval/imaging/image_formation.h>

#include <vector>

namespace petzval {

/// What of a scene's contrast is how fine: one band of it.
struct DetailSpectrum {
  double mean = 0;
  /// The variance within squares of 2, 4, 8 … times the finest side that is not within those of half the
  /// side: the mean of squares from the first sample on and of those from the second on.
  std::vector<double> variances;
  double finest_side = 1;  ///< [samples]
  bool drawn = false;      ///< figures, not straight lines between samples
};
/// Of a drawing, below the samples: an edge is met by half as many squares of half the side, so each step
/// down has half the variance.
DetailSpectrum detail_of(const Scene& scene, int band);

/// A relative L2 error of a picture.
struct SamplingError {
  double error = 0;
  double finer = 0;  ///< the part of detail of a drawing finer than pixels can hold

  /// Whether it leaves half of the tolerance to the blur. All of it may be √3/2 of the tolerance, but half
  /// without finer detail: what is estimated of that is more than is there.
  bool is_within(double tolerance) const {
    return error * error - finer * finer <= tolerance * tolerance / 4 &&
           error * error <= 0.75 * tolerance * tolerance;
  }
};

/// The relative L2 error of a picture whose pixels are so many cells wide, whatever the blur method: detail
/// that cells cannot hold, and kernels' samples that mistake one frequency for another. The edges of a
/// drawing have no end of detail: what is beyond half a cycle a pixel, and a sample, is `finer`.
///
/// \param samples_per_pixel  of the scene, along a side. \param mtf  of the lens over cycles/pixel.
SamplingError sampling_error(const DetailSpectrum& detail, double samples_per_pixel, const Photosite& site,
                             int cells, const LightPath& path, const std::function<double(double)>& mtf);

/// How many cells a pixel gets, and the sampling_error() that they leave.
struct CellChoice {
  int cells = 1;
  SamplingError sampling = {};
  /// Standard deviation of the light of cells over its mean, were all detail of the scene as strong as its
  /// finest: large for lights in darkness.
  double contrast = 0;
};

/// The cells that the options name; else the fewest whose sampling_error(), in the scene's middle band and
/// through the table's MTF, RMS over the frame, is within the tolerance (SamplingError::is_within): 2 at
/// least, but for tolerances of 3·10⁻³ and more, and ImagingOptions::most_cells at most.
CellChoice choose_cells(const Scene& scene, const LensDataTable& table, const SensorGeometry& sensor,
                        const ImagingOptions& options);

}  // namespace petzval
