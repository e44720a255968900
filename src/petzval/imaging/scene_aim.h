// SPDX-License-Identifier: BSD-3-Clause
// A camera that is turned from the middle of a plane scene, or a scene that has moved.
#pragma once

#include <petzval/imaging/row_view.h>
#include <petzval/imaging/scene_look.h>
#include <petzval/scene/scene.h>

namespace petzval {

/// Where a camera looks and where its scene is, from how they stand when the camera looks at the middle of
/// the scene.
struct SceneAim {
  double pan_deg = 0, pitch_deg = 0;  ///< the camera, to the right, then up: of a scene at infinity
  double right_m = 0, up_m = 0;       ///< the scene, as seen from the camera: of one at a finite distance

  bool operator==(const SceneAim&) const = default;
  bool is_straight() const { return *this == SceneAim{}; }
  /// \throws InputError for a turn before a scene at a finite distance, whose plane would be out of focus at
  /// its sides, and a way of a scene at infinity, which would not be seen.
  void check(const Scene& scene) const;
};

/// From what a camera that looks straight sees to what it sees: places of a plane scene, from its middle, in
/// samples. A turned camera sees the plane by central projection, exactly.
class AimedPlane {
 public:
  AimedPlane(const SceneAim& aim, const Scene& scene);

  bool is_straight() const { return straight_; }
  struct Place {
    double right, down;            ///< [samples]
    double widening, heightening;  ///< of a small rectangle
  };
  /// Not a number, for a place beside or behind which the plane is not seen.
  Place at(double right, double down) const;
  /// What a row of cells sees, from what it would see straight. Cells that do not see the plane are dark.
  void turn(const RowView& straight, RowView& turned) const;

 private:
  bool straight_, turned_;
  PlaneTurn turn_;
  double shift_right_, shift_down_;  ///< [samples]
};

}  // namespace petzval
