// SPDX-License-Identifier: BSD-3-Clause
// What is seen in a direction of a panorama.
#pragma once

#include <petzval/scene/scene.h>

#include <cstddef>
#include <memory>
#include <vector>

namespace petzval {

/// One band of an equirectangular scene, made ready to be looked up by direction.
///
/// Towards the poles samples crowd: each stands for as much of its row as makes it as wide as a sample of the
/// equator, so that everywhere directions a sample of the equator apart miss nothing. Between samples
/// radiance is bilinear, round the circle and over the poles.
class PanoramaBand {
 public:
  PanoramaBand(const Scene& panorama, int band, PanoramaView view);
  /// The same band, looked at by a camera that is turned otherwise.
  PanoramaBand(const PanoramaBand& other, PanoramaView view);

  /// Radiance at a place of the azimuthal equidistant map about the optical axis: its distance from the
  /// middle is the angle from the axis. \param right, down  in samples of the equator (SceneMap::Place less
  /// the middle).
  double radiance(double right, double down) const;

 private:
  double sample(std::ptrdiff_t row, double column) const;

  std::ptrdiff_t columns_, rows_;
  double angle_per_sample_;
  double cos_yaw_, sin_yaw_, cos_pitch_, sin_pitch_;
  std::shared_ptr<const std::vector<float>> values_;
};

}  // namespace petzval
