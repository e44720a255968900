// SPDX-License-Identifier: BSD-3-Clause
// Rays of a point of a source towards a lens.
#pragma once

#include <petzval/flare/bright_source.h>
#include <petzval/trace/tracer.h>

#include <array>
#include <vector>

namespace petzval {

/// One point of a source. Rays are named by where they cross the plane of the first vertex.
class SourceBeam {
 public:
  /// \param across  place on the source's disc, from its middle, over its radius: to one side and to the
  /// other; it faces the first vertex.
  SourceBeam(const BrightSource& source, std::array<double, 2> across = {0, 0});

  Ray ray(double x_mm, double y_mm) const;
  /// What falls on a unit of the plane there, over the irradiance across the light at the first vertex.
  double weight(double x_mm, double y_mm) const;
  /// Of its ray through the first vertex: dx/dz and dy/dz.
  std::array<double, 2> slope() const { return {-towards_[0] / towards_[2], -towards_[1] / towards_[2]}; }

 private:
  std::array<double, 3> towards_;  ///< the source, unit, in the axes of the photographer: right, up, ahead
  double distance_mm_ = 0;         ///< along the axis; 0: infinitely far
};

/// `count` places that share the unit disc out evenly (H. Vogel 1979).
std::vector<std::array<double, 2>> even_disc(int count);

/// The unit disc in rings of triangles that share their corners.
struct DiscMesh {
  std::vector<std::array<double, 2>> nodes;
  std::vector<std::array<std::size_t, 3>> triangles;
  std::vector<double> shares;  ///< of each triangle in the disc

  static DiscMesh of_rings(int rings);
};

}  // namespace petzval
