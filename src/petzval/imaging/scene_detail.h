// SPDX-License-Identifier: BSD-3-Clause
// How fine the detail of a scene is.
#pragma once

#include <petzval/imaging/frame_zones.h>
#include <petzval/scene/scene.h>

#include <array>
#include <deque>
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

/// What neighbouring samples of a band differ by, as noise of the same differences does
/// (variance_of_neighbours), over the mean of the band; 0 of darkness.
double contrast_of_samples(const Scene& scene, int band);

/// The detail of one scene for one image after another: what was looked at last is kept. Each lens shows the
/// scene at a scale of its own, so scales are rounded, here and wherever a detail is to be the same for a
/// single image.
class KnownDetail {
 public:
  /// To the nearest of 64 steps in a factor of two: frequencies are off by half a per cent at most.
  static double rounded_scale(double samples_per_pixel);
  /// detail_of() at the rounded scale. \param scene  always the same. \return  valid until the next call.
  const SceneDetail& of(const Scene& scene, int band, double samples_per_pixel, const SensorGeometry& sensor);
  /// How often it had to look.
  int looks() const { return looks_; }

 private:
  struct Key {
    int band;
    double samples_per_pixel;
    int columns, rows;
    double pitch_um;
    bool operator==(const Key&) const = default;
  };
  struct Known {
    Key key;
    SceneDetail detail;
  };
  std::deque<Known> known_;
  int looks_ = 0;
};

}  // namespace petzval
