// SPDX-License-Identifier: BSD-3-Clause
// How blurred an object is by its distance, to first order.
#pragma once

#include <petzval/lens/lens.h>

#include <optional>

namespace petzval {

/// A lens with its sensor where it is. The paraxial blur of a point on the axis is a disc whose diameter is
/// linear in the reciprocal of its distance from the entrance pupil,
///
///     b(s) = k (1/s − 1/s_focus),
///
/// exactly: the marginal ray is linear in the slope with which it enters the pupil, 1/s of its radius.
class DefocusLaw {
 public:
  /// \throws InputError for a lens telecentric in object space, which has no viewpoint, or one that forms no
  /// image.
  explicit DefocusLaw(const Lens& lens);

  /// The viewpoint: the paraxial entrance pupil, in front of the sensor plane [mm].
  double pupil_to_sensor_mm() const { return pupil_to_sensor_mm_; }
  /// Reciprocal of the distance from the pupil [1/mm] of an object at a distance from the sensor plane
  /// (absent: infinity).
  double vergence(std::optional<double> distance_m) const;
  /// The inverse; nothing for 0 and below.
  std::optional<double> distance_m(double vergence) const;
  /// Signed diameter [µm]: positive for objects nearer than what is in focus.
  double blur_um(double vergence) const { return um_per_vergence_ * (vergence - focus_); }
  double vergence_of_blur(double blur_um) const { return focus_ + blur_um / um_per_vergence_; }

 private:
  double pupil_to_sensor_mm_ = 0;
  double um_per_vergence_ = 0, focus_ = 0;
};

}  // namespace petzval
