// SPDX-License-Identifier: BSD-3-Clause
// One ray, refraction by refraction: for teaching, and for finding out where a ray goes.
#pragma once

#include <petzval/analysis/stop_aim.h>

#include <array>
#include <optional>
#include <string>
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

/// The ray from a point of the film at this height (on +y as the lens images it) backwards through a point of
/// the stop, whatever apertures there are: surfaces from the last to the first. Empty where the glass brings
/// no ray there.
std::vector<RayStep> ray_steps_from_film(const Tracer& tracer, double height_mm, double stop_x,
                                         double stop_y);

/// Where a ray ends.
struct BlockedRay {
  RayStatus why = RayStatus::ok;
  int surface = -1;
  /// Of a ray that an aperture stops: where it crosses the surface, from the axis, and where that ends.
  double radius_mm = 0, clear_radius_mm = 0;

  double beyond_mm() const { return radius_mm - clear_radius_mm; }
  /// "ends at surfaces[3], 12.3 mm from the axis, 2.1 mm beyond its clear aperture".
  std::string text() const;
};
/// Nothing for a ray that reaches the image. \param ray  in object space.
std::optional<BlockedRay> blocked(const Tracer& tracer, const Ray& ray,
                                  Tracer::Clip clip = Tracer::Clip::apertures);
/// The same for the ray of a field through a point of the stop; nothing also for one that the glass does not
/// bring there.
std::optional<BlockedRay> blocked(const FieldTracer& tracer, double object_field, double stop_x,
                                  double stop_y);

}  // namespace petzval
