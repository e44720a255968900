// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
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

/// Steps along a path through these surfaces; what lies before and behind a surface changes places for light
/// that runs backwards. \param at  where the path begins.
std::vector<RayStep> steps_along(const Tracer& glass, const std::vector<Intersection>& path, Vector at,
                                 Vector direction, bool backward) {
  std::vector<RayStep> steps;
  const std::size_t last = glass.surface_count();
  double opl_mm = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const std::size_t surface = backward ? last - 1 - i : i;
    const bool image = surface == last;
    const double front = image ? glass.image_index() : glass.surfaces()[surface].index_before;
    const double back = image ? glass.image_index() : glass.surfaces()[surface].index_after;
    RayStep step;
    step.surface = static_cast<int>(surface);
    step.point_mm = path[i].point_mm;
    step.normal = path[i].normal;
    step.direction_before = direction;
    step.direction_after = image ? direction : path[i].direction_after;
    step.index_before = backward ? back : front;
    step.index_after = backward ? front : back;
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

}  // namespace

std::vector<RayStep> ray_steps(const FieldTracer& tracer, const ChiefRay& chief, double stop_x,
                               double stop_y) {
  std::optional<StopAim> aim = StopAim::of(tracer, chief);
  const std::optional<Ray> launched = aim ? aim->launch(stop_x, stop_y) : std::nullopt;
  if (!launched) return {};
  std::vector<Intersection> path;
  tracer.tracer().trace(*launched, Tracer::Clip::none, &path);
  const Pencil pencil = Pencil::from_object(tracer.lens(), chief.object_field);
  return steps_along(tracer.tracer(), path,
                     pencil.object_at_infinity() ? launched->point_mm : pencil.point_mm(),
                     launched->direction, false);
}

std::vector<RayStep> ray_steps_from_film(const Tracer& tracer, double height_mm, double stop_x,
                                         double stop_y) {
  const double image_z = tracer.image_z_mm(), radius = tracer.stop_radius_mm();
  const double to_last = -std::abs(image_z - tracer.vertex_z_mm(tracer.surface_count() - 1));
  // By the slopes to the plane through the last vertex, where Newton's method begins in the middle.
  const auto from_film = [&](double x_mm, double y_mm) {
    const double dx = x_mm, dy = y_mm - height_mm, dz = to_last, length = std::hypot(dx, dy, dz);
    return Ray{{0, height_mm, image_z}, {dx / length, dy / length, dz / length}};
  };
  const auto miss = [&](double x_mm, double y_mm) -> std::optional<std::array<double, 2>> {
    const Tracer::Clearance at = tracer.clearance(from_film(x_mm, y_mm), true, Tracer::Clip::none);
    if (!at.reached_stop) return {};
    return std::array{at.stop_x_mm - stop_x * radius, at.stop_y_mm - stop_y * radius};
  };
  double x = 0, y = 0;
  const double small = 1e-6 * radius;
  constexpr int steps = 30;
  for (int step = 0; step < steps; ++step) {
    const auto here = miss(x, y), right = miss(x + small, y), up = miss(x, y + small);
    if (!here || !right || !up) return {};
    if (std::hypot((*here)[0], (*here)[1]) < 1e-11 * radius) break;
    const double a = ((*right)[0] - (*here)[0]) / small, b = ((*up)[0] - (*here)[0]) / small;
    const double c = ((*right)[1] - (*here)[1]) / small, d = ((*up)[1] - (*here)[1]) / small;
    const double det = a * d - b * c;
    if (!(std::abs(det) > 0)) return {};
    x -= (d * (*here)[0] - b * (*here)[1]) / det, y -= (a * (*here)[1] - c * (*here)[0]) / det;
  }
  const auto end = miss(x, y);
  constexpr double close = 1e-6;
  if (!end || !(std::hypot((*end)[0], (*end)[1]) < close * radius)) return {};
  std::vector<Intersection> path;
  const Ray ray = from_film(x, y);
  if (tracer.trace_backward(ray, Tracer::Clip::none, &path).status != RayStatus::ok) return {};
  const Frame& sensor = tracer.sensor_frame();
  return steps_along(
      tracer, path, sensor.point_to_lens(ray.point_mm, image_z),
      sensor.to_lens({ray.direction[0], ray.direction[1], tracer.image_sense() * ray.direction[2]}), true);
}

std::string BlockedRay::text() const {
  if (why == RayStatus::missed) return fmt::format("misses surfaces[{}]", surface);
  if (why == RayStatus::tir) return fmt::format("is totally reflected at surfaces[{}]", surface);
  return fmt::format("ends at surfaces[{}], {:.4g} mm from the axis, {:.3g} mm beyond its clear aperture",
                     surface, radius_mm, beyond_mm());
}

std::optional<BlockedRay> blocked(const Tracer& tracer, const Ray& ray, Tracer::Clip clip) {
  const Ray end = tracer.trace(ray, clip);
  if (end.status == RayStatus::ok) return {};
  BlockedRay result{end.status, end.failed_at, 0, 0};
  if (end.status != RayStatus::vignetted) return result;
  std::vector<Intersection> path;
  tracer.trace(ray, Tracer::Clip::none, &path);
  const auto surface = static_cast<std::size_t>(end.failed_at);
  if (surface >= path.size()) return result;
  const Frame& frame = tracer.surfaces()[surface].frame;
  const Vector own = frame.point_from_lens(path[surface].point_mm, tracer.vertex_z_mm(surface));
  result.radius_mm = std::hypot(own[0], own[1]);
  result.clear_radius_mm = std::sqrt(tracer.clip_radius_sq(surface, clip));
  return result;
}

std::optional<BlockedRay> blocked(const FieldTracer& tracer, double object_field, double stop_x,
                                  double stop_y) {
  const Tracer& glass = tracer.tracer();
  FieldTracer open(tracer.lens(), glass.wavelength_nm(), Tracer::Clip::stop_only);
  const std::optional<ChiefRay> chief = open.chief_ray(object_field);
  std::optional<StopAim> aim = chief ? StopAim::of(open, *chief) : std::nullopt;
  const std::optional<Ray> launched = aim ? aim->launch(stop_x, stop_y) : std::nullopt;
  return launched ? blocked(glass, *launched, tracer.clip()) : std::nullopt;
}

}  // namespace petzval
