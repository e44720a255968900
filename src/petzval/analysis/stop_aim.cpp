// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/stop_aim.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// Distance to the neighbouring rays of a derivative, per pupil radius.
constexpr double aim_nudge_per_radius = 1e-5;
/// A ray is aimed when it crosses the stop this near (in stop radii); Newton's last step squares its error.
constexpr double stop_aim_tolerance = 1e-10;
constexpr int newton_steps = 20;
/// Strides from the chief ray when the short way fails.
constexpr int strides = 12;
/// A ray aimed at the rim itself passes: relative to r² of an aperture.
constexpr double rim_tolerance = 1e-9;
constexpr int coarse_azimuths = 16;

}  // namespace

StopAim::StopAim(const FieldTracer& tracer, const ChiefRay& chief, double nudge)
    : tracer_(&tracer),
      chief_(chief),
      pencil_(Pencil::from_object(tracer.lens(), chief.object_field)),
      nudge_(nudge),
      radius_mm_(tracer.tracer().stop_radius_mm()),
      start_{0, 0, chief.u, chief.v},
      last_(start_) {}

std::optional<StopAim> StopAim::of(const FieldTracer& tracer, const ChiefRay& chief) {
  const std::optional<PupilBoundary> pupil = tracer.object_pupil(chief, coarse_azimuths);
  if (!pupil) return {};
  const double radius = *std::max_element(pupil->radius.begin(), pupil->radius.end());
  return StopAim(tracer, chief, aim_nudge_per_radius * radius);
}

std::optional<Tracer::Clearance> StopAim::trace(double u, double v) const {
  const Tracer::Clearance traced = pencil_.clearance(tracer_->tracer(), u, v, tracer_->clip());
  if (!traced.reached_stop) return {};
  return traced;
}

std::optional<StopAim::Found> StopAim::search(double x_mm, double y_mm, const Found& from) const {
  const double close = std::max(stop_aim_tolerance * radius_mm_, pencil_.rounding_mm());
  double u = from.u, v = from.v;
  for (int step = 0; step < newton_steps; ++step) {
    const auto at = trace(u, v), right = trace(u + nudge_, v), above = trace(u, v + nudge_);
    if (!at || !right || !above) return {};
    const double miss_x = x_mm - at->stop_x_mm, miss_y = y_mm - at->stop_y_mm;
    if (std::hypot(miss_x, miss_y) < close) return Found{x_mm, y_mm, u, v};
    const double x_u = right->stop_x_mm - at->stop_x_mm, y_u = right->stop_y_mm - at->stop_y_mm;
    const double x_v = above->stop_x_mm - at->stop_x_mm, y_v = above->stop_y_mm - at->stop_y_mm;
    const double scale = nudge_ / (x_u * y_v - x_v * y_u);
    if (!std::isfinite(scale)) return {};
    u += (miss_x * y_v - miss_y * x_v) * scale;
    v += (miss_y * x_u - miss_x * y_u) * scale;
  }
  return {};
}

/// Finds the ray, leaves it in last_, and says how it got through; nothing where it does not.
std::optional<Tracer::Clearance> StopAim::aimed(double x, double y) {
  const double x_mm = x * radius_mm_, y_mm = y * radius_mm_;
  std::optional<Found> found = search(x_mm, y_mm, last_);
  for (int i = 1; !found && i <= strides; ++i) {
    const double share = static_cast<double>(i) / strides;
    const std::optional<Found> nearer = search(share * x_mm, share * y_mm, i == 1 ? start_ : last_);
    if (!nearer) return {};
    last_ = *nearer;
    if (i == strides) found = nearer;
  }
  if (!found) return {};
  last_ = *found;
  std::optional<Tracer::Clearance> traced = trace(found->u, found->v);
  if (traced->ray.status != RayStatus::ok || !(traced->worst <= rim_tolerance)) return {};
  return traced;
}

std::optional<PupilRay> StopAim::ray(double x, double y) {
  const std::optional<Tracer::Clearance> traced = aimed(x, y);
  if (!traced) return {};
  PupilRay ray;
  ray.x_mm = traced->ray.point_mm[0] - chief_.image_x_mm;
  ray.y_mm = traced->ray.point_mm[1] - chief_.image_height_mm;
  ray.alpha = traced->ray.direction[0];
  ray.beta = traced->ray.direction[1];
  ray.path_mm = traced->ray.opl_mm - chief_.at_image.opl_mm;
  ray.stop_x_mm = traced->stop_x_mm;
  ray.stop_y_mm = traced->stop_y_mm;
  return ray;
}

std::optional<Ray> StopAim::launch(double x, double y) {
  if (!aimed(x, y)) return {};
  return pencil_.ray(last_.u, last_.v);
}

}  // namespace petzval
