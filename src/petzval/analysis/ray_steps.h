// SPDX-License-Identifier: BSD-3-Clause
// One ray, refraction by refraction: for teaching, and for finding out where a ray goes.
#pragma once

#include <petzval/analysis/stop_aim.h>

#include <array>
#include <vector>

namespace petzval {

/// What happens to a ray at one surface. In lens space; directions and normals are unit vectors.
struct RayStep {
  int surface = 0;  ///< the image surface counts as one more than the last
  std::array<double, 3> point_mm{};
  std::array<double, 3> normal{};  ///< on the +z side at the vertex
  std::array<double, 3> direction_before{}, direction_after{};
  double index_before = 1, index_after = 1;
  double incidence_deg = 0, refraction_deg = 0;  ///< angles against the normal, 0 to 90
  double path_mm = 0;  ///< of the stretch that ends here; the first one begins at the launch plane or object
  double opl_mm = 0;   ///< optical path to here
};

/// The ray of a field through a point (x, y) of the stop [stop radii]. Empty where there is none or an
/// aperture stops it.
std::vector<RayStep> ray_steps(const FieldTracer& tracer, const ChiefRay& chief, double stop_x,
                               double stop_y);

}  // namespace petzval
