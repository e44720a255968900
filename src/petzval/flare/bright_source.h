// SPDX-License-Identifier: BSD-3-Clause
// A source so bright that its stray light shows.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// A small disc of light in front of a lens: the Sun, a lamp, a bright patch of a scene.
struct BrightSource {
  std::string name = {};
  /// Tangents of its angles from the axis, to the right and upwards as the photographer sees it, from the
  /// first vertex.
  double right = 0, up = 0;
  std::optional<double> distance_mm = {};  ///< along the axis to the first vertex; absent: infinitely far
  double radius_rad = 0;                   ///< half the angle that it is seen under; 0: a point
  /// Of each wavelength, at the first vertex, across the direction of the light [W·m⁻²·nm⁻¹].
  std::vector<double> irradiance = {};

  /// \throws InputError for another number of wavelengths, a place that is not finite or a distance that is
  /// not positive, a radius outside 0 to 45 degrees, and light that is negative.
  void validate(std::size_t wavelengths) const;
};

}  // namespace petzval
