// SPDX-License-Identifier: BSD-3-Clause
// A camera that moves while its shutter is open.
#pragma once

#include <petzval/render/transform.h>

namespace petzval::render {

/// The camera's place and what it looks at move evenly from time 0, when the first row begins to be exposed,
/// to time 1, when the last one ends. Every row is exposed equally long; each begins later than the one
/// above it, if `row_share` is above 0.
struct CameraMotion {
  Vector3 eye, target;            ///< at time 0, world space
  Vector3 eye_move, target_move;  ///< from time 0 to 1
  Vector3 up{0, 1, 0};            ///< world space
  bool mirrored = false;          ///< left and right change places
  double row_share = 0;           ///< of the time: between the beginnings of the first row and the last

  /// \throws InputError (without place) where the eye meets its target.
  Transform world_from_camera(double time) const {
    const Transform looks = Transform::look_at(eye + time * eye_move, target + time * target_move, up);
    return mirrored ? looks.inverse() * Transform::scaling({-1, 1, 1}) : looks.inverse();
  }
  /// The time at which a row begins. \param row  of its middle, in pixels from the upper edge of the film.
  double opens(double row, int rows) const { return row_share * (row - 0.5) / (rows > 1 ? rows - 1 : 1); }
  double exposure() const { return 1 - row_share; }
};

}  // namespace petzval::render
