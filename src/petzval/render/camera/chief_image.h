// SPDX-License-Identifier: BSD-3-Clause
// Where the chief ray of a point of the scene lands.
#pragma once

#include <petzval/lens/lens.h>
#include <petzval/numeric/interpolation.h>
#include <petzval/trace/tracer.h>

#include <optional>

namespace petzval::render {

/// The chief rays of a centred lens at one wavelength, as curves over their angle θ in the object space: each
/// is a line that crosses the axis at z(θ), the pupil as it is seen from there, and lands at the height h(θ).
class ChiefImage {
 public:
  /// \param reach_mm  heights on the film that are wanted; curves end where chief rays do.
  /// \throws InputError if there are none.
  ChiefImage(const Lens& lens, double wavelength_nm, Tracer::Clip clip, double reach_mm);

  /// Where lines of no angle cross the axis [mm, lens space].
  double pupil_z_mm() const { return pupil_z_mm_; }
  /// The line through a point at a radius from the axis, and z [mm]; or in a direction. Radians, 0 or more;
  /// nothing behind the pupil or beyond the last chief ray.
  std::optional<double> angle_of(double radius_mm, double z_mm) const;
  std::optional<double> angle_of_direction(double across, double along) const;
  /// [mm], signed along the radius of the object: negative where the image is inverted.
  double height_mm(double angle) const { return height_(angle); }
  /// The angle that lands at the height |h|; at most the last.
  double angle_at(double height_mm) const;
  /// Of the line, at z: the radius.
  double radius_mm(double angle, double z_mm) const;
  double last_height_mm() const;

 private:
  double pupil_z_mm_ = 0;
  MonotoneCubic crossing_, height_;
};

}  // namespace petzval::render
