// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/ray_steps.h>
#include <petzval/base/units.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

using Vector = std::array<double, 3>;

double angle_deg(const Vector& direction, const Vector& normal) {
  const double cosine =
      std::abs(direction[0] * normal[0] + direction[1] * normal[1] + direction[2] * normal[2]);
  return degrees(std::acos(std::min(cosine, 1.0)));
}

/// Signed length of a stretch, negative where surfaces cross and the ray runs back.
double stretch_mm(const Vector& from, const Vector& to, const Vector& direction) {
  return (to[0] - from[0]) * direction[0] + (to[1] - from[1]) * direction[1] +
         (to[2] - from[2]) * direction[2];
}

}  // namespace

std::vector<RayStep> ray_steps(const FieldTracer& tracer, const ChiefRay& chief, double stop_x,
                               double stop_y) {
  std::optional<StopAim> aim = StopAim::of(tracer, chief);
  const std::optional<Ray> launched = aim ? aim->launch(stop_x, stop_y) : std::nullopt;
  if (!launched) return {};
  const Tracer& glass = tracer.tracer();
  std::vector<Intersection> path;
  glass.trace(*launched, Tracer::Clip::none, &path);
  std::vector<RayStep> steps;
  const Pencil pencil = Pencil::from_object(tracer.lens(), chief.object_field);
  Vector at = pencil.object_at_infinity() ? launched->point_mm : pencil.point_mm();
  Vector direction = launched->direction;
  double opl_mm = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const bool image = i == glass.surface_count();
    RayStep step;
    step.surface = static_cast<int>(i);
    step.point_mm = path[i].point_mm;
    step.normal = image ? Vector{0, 0, 1} : path[i].normal;
    step.direction_before = direction;
    step.direction_after = image ? direction : path[i].direction_after;
    step.index_before = image ? glass.image_index() : glass.surfaces()[i].index_before;
    step.index_after = image ? glass.image_index() : glass.surfaces()[i].index_after;
    step.incidence_deg = angle_deg(step.direction_before, step.normal);
    step.refraction_deg = angle_deg(step.direction_after, step.normal);
    step.path_mm = stretch_mm(at, step.point_mm, direction);
    opl_mm += step.index_before * step.path_mm;
    step.opl_mm = opl_mm;
    steps.push_back(step);
    at = step.point_mm;
    direction = step.direction_after;
  }
  return steps;
}

}  // namespace petzval
