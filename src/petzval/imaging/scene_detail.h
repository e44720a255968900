// SPDX-License-Identifier: BSD-3-Clause
// How fine the detail of a scene is.
#pragma once

#include <petzval/imaging/frame_zones.h>
#include <petzval/scene/scene.h>

#include <array>
#include <vector>

namespace petzval {

/// The detail of a scene on a frame, by its frequency.
struct SceneDetail {
  double mean = 0;  ///< of the light
  /// The variance of strips, along rows and along columns added up, in each zone of a frame by DetailBands.
  std::array<std::vector<double>, FrameZones::count> power;
  /// Half the mean square of the step from one sample to the next: of white noise, its variance.
  double variance_of_neighbours = 0;
};

/// Power spectra of strips along the rows and columns of what a frame shows, by Welch's method: pieces under
/// a Hann window, which overlap by half. Strips of samples are one pixel wide, if there are samples enough;
/// between samples light runs along straight lines, so that their images beyond the samples' own frequency
/// have a part of the power. Strips of a chart come from its figures, at 64 steps a pixel. They are a quarter
/// of a pixel wide: wider ones hide fine waves aslant.
///
/// \param samples_per_pixel  along a side, on the axis: distortion is left out.
/// (P. D. Welch, The use of fast Fourier transform for the estimation of power spectra, 1967.)
SceneDetail detail_of(const Scene& scene, int band, double samples_per_pixel, const SensorGeometry& sensor);

}  // namespace petzval
