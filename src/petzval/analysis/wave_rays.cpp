// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/wave_rays.h>
#include <petzval/base/units.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval {

namespace {

/// Finite differences of the exit direction, as a share of the pupil: truncation and rounding both near 1e-8.
constexpr double wave_nudge_per_radius = 1e-6;

/// More where the object is so far away that labels have few digits within the pupil: the share at which
/// rounding is as large as truncation.
double nudge_for(const PupilBoundary& pupil) {
  const double radius = *std::max_element(pupil.radius.begin(), pupil.radius.end());
  const double rounding = std::numeric_limits<double>::epsilon() * std::abs(pupil.centre_v) / radius;
  return radius * std::max(wave_nudge_per_radius, std::sqrt(rounding));
}

/// A node's ray and its neighbours at u − nudge and v − nudge.
constexpr std::size_t rays_per_node = 3;

RayBatch trace_with_neighbours(const FieldTracer& tracer, const Pencil& pencil,
                               const std::vector<PupilNode>& nodes, double nudge) {
  RayBatch rays;
  const auto launch = [&](double u, double v) {
    // Labels outside the unit disc have no ray; a ray along the axis' perpendicular fails in the trace.
    const Ray ray = pencil.ray(u, v).value_or(Ray{{0, 0, 0}, {1, 0, 0}});
    rays.push_back(ray.point_mm[0], ray.point_mm[1], ray.point_mm[2], ray.direction[0], ray.direction[1],
                   ray.direction[2], ray.opl_mm);
  };
  for (const PupilNode& node : nodes) {
    launch(node.u, node.v);
    launch(node.u - nudge, node.v);
    launch(node.u, node.v - nudge);
  }
  tracer.tracer().trace(rays, Tracer::Clip::none);
  return rays;
}

/// T of the ray that was launched at a node.
double transmittance_at(const FieldTracer& tracer, const Pencil& pencil, const PupilNode& node) {
  if (!tracer.transmittance()) return 1;
  const Ray launched = *pencil.ray(node.u, node.v);
  std::vector<Intersection> path;
  tracer.tracer().trace(launched, Tracer::Clip::none, &path);
  return tracer.transmittance()->along(launched, path);
}

/// |∂(α, β)/∂(u, v)| from a ray and its two neighbours; 0 where one of them fails.
double exit_jacobian(const RayBatch& rays, std::size_t ray, double nudge) {
  if (rays.status[ray + 1] != RayStatus::ok || rays.status[ray + 2] != RayStatus::ok) return 0;
  const double du_alpha = rays.l[ray] - rays.l[ray + 1], du_beta = rays.m[ray] - rays.m[ray + 1];
  const double dv_alpha = rays.l[ray] - rays.l[ray + 2], dv_beta = rays.m[ray] - rays.m[ray + 2];
  return std::abs(du_alpha * dv_beta - du_beta * dv_alpha) / (nudge * nudge);
}

}  // namespace

std::vector<WaveRay> trace_wave_rays(const FieldTracer& tracer, const ChiefRay& chief,
                                     const PupilBoundary& pupil, const std::vector<PupilNode>& nodes) {
  const Pencil pencil = Pencil::from_object(tracer.lens(), chief.object_field);
  const double outwards = chief.image_height_mm < 0 ? -1.0 : 1.0;
  const double index = tracer.tracer().image_index();
  const double lambda_mm = tracer.tracer().wavelength_nm() * mm_per_nm;
  const double nudge = nudge_for(pupil);
  const RayBatch rays = trace_with_neighbours(tracer, pencil, nodes, nudge);

  std::vector<WaveRay> waves(nodes.size());
  for (std::size_t node = 0; node < nodes.size(); ++node) {
    const std::size_t ray = rays_per_node * node;
    if (rays.status[ray] != RayStatus::ok) continue;
    const double x_mm = rays.x_mm[ray] - chief.image_x_mm, y_mm = rays.y_mm[ray] - chief.image_height_mm;
    const double to_foot_mm = -x_mm * rays.l[ray] - y_mm * rays.m[ray];
    WaveRay& wave = waves[node];
    wave.passes = true;
    wave.alpha = outwards * rays.l[ray];
    wave.beta = outwards * rays.m[ray];
    wave.phase_waves = (rays.opl_mm[ray] + index * to_foot_mm - chief.at_image.opl_mm) / lambda_mm;
    wave.transmittance = transmittance_at(tracer, pencil, nodes[node]);
    // dq = du dv, and dα dβ = |∂(α, β)/∂(u, v)| du dv.
    const double jacobian = exit_jacobian(rays, ray, nudge);
    wave.amplitude = jacobian > 0 ? std::sqrt(wave.transmittance / jacobian) : 0;
    wave.s_mm = outwards * x_mm;
    wave.t_mm = outwards * y_mm;
  }
  return waves;
}

}  // namespace petzval
