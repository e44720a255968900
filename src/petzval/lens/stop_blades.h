// SPDX-License-Identifier: BSD-3-Clause
// An iris whose blades make the stop a polygon.
#pragma once

#include <array>
#include <vector>

namespace petzval {

/// A regular polygon with its corners on the circle of the stop, which it never reaches beyond.
struct StopBlades {
  int count = 0;  ///< edges; 0: a round stop
  /// Of the first corner from the top of the stop (+y), anticlockwise as seen from the film.
  double rotation_deg = 0;

  static constexpr int most = 64;

  /// \throws InputError unless there are none or 3 to 64, and the rotation is finite.
  void validate() const;
  /// Unit normals of the edges in lens space (x, y), outwards.
  std::vector<std::array<double, 2>> normals() const;
  /// Distance of the edges from the middle over the radius of the stop: cos(π/count).
  double apothem() const;
  /// How far the polygon reaches in a direction (unit, in lens space) over the radius of the stop; 1 without
  /// blades.
  double reach(double x, double y) const;
  /// Area over that of the round stop: count/(2π) · sin(2π/count).
  double area_share() const;
};

}  // namespace petzval
