// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/point_spread.h>
#include <petzval/base/units.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

constexpr double spacing_per_lambda_n = 0.45;
constexpr double margin_lambda_n = 12;
constexpr int smallest_size = 32;
constexpr int size_step = 8;
constexpr int scout_radial = 6, scout_azimuths = 24;
/// Finite differences of the exit direction, as a share of the pupil: truncation and rounding both near 1e-8.
constexpr double nudge_per_radius = 1e-6;

struct ExitRay {
  double alpha, beta, x_mm, y_mm, opl_mm;
};

std::optional<ExitRay> exit_ray(const FieldTracer& tracer, const Pencil& pencil, double u, double v) {
  const std::optional<Ray> launched = pencil.ray(u, v);
  if (!launched) return {};
  const Ray ray = tracer.tracer().trace(*launched, Tracer::Clip::none);
  if (ray.status != RayStatus::ok) return {};
  return ExitRay{ray.direction[0], ray.direction[1], ray.point_mm[0], ray.point_mm[1], ray.opl_mm};
}

/// Extent of the light at the image point.
struct Extent {
  double alpha_width = 0, beta_width = 0;  ///< of the pupil in direction cosines
  double transverse_mm = 0;                ///< largest distance of a ray from the chief ray's image
};

std::optional<Extent> scout(const FieldTracer& tracer, const ChiefRay& chief) {
  const std::optional<PupilBoundary> pupil = tracer.object_pupil(chief, scout_azimuths);
  if (!pupil) return {};
  const Pencil pencil = Pencil::from_object(tracer.lens(), chief.object_field);
  Extent extent;
  double low = 2, high = -2;
  std::vector<PupilNode> nodes = half_pupil_nodes(*pupil, scout_radial);
  for (std::size_t i = 0; i < pupil->radius.size() / 2; ++i)  // the rim itself
    nodes.push_back({pupil->radius[i] * std::sin(pupil->azimuth(i)),
                     pupil->centre_v + pupil->radius[i] * std::cos(pupil->azimuth(i)), 0});
  for (const PupilNode& node : nodes)
    if (const auto ray = exit_ray(tracer, pencil, node.u, node.v)) {
      low = std::min(low, ray->beta);
      high = std::max(high, ray->beta);
      extent.alpha_width = std::max(extent.alpha_width, 2 * std::abs(ray->alpha));
      extent.transverse_mm =
          std::max(extent.transverse_mm, std::hypot(ray->x_mm, ray->y_mm - chief.image_height_mm));
    }
  extent.beta_width = high - low;
  if (!(extent.beta_width > 0) || !(extent.alpha_width > 0)) return {};
  return extent;
}

/// Nodes that integrate e^{iB…} to rounding: B rad of phase at the rim need B + O(B^⅓) azimuths (the
/// trapezoid rule aliases only the B-th harmonic and above) and half as many Gauss-Legendre nodes.
int azimuths_for(double phase) {
  return 2 * static_cast<int>(std::ceil(0.5 * (phase + 5 * std::cbrt(phase) + 64)));
}
int radial_for(double phase) {
  return static_cast<int>(std::ceil(0.5 * phase + 3 * std::cbrt(phase) + 12));
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
                   ray.direction[2]);
  };
  for (const PupilNode& node : nodes) {
    launch(node.u, node.v);
    launch(node.u - nudge, node.v);
    launch(node.u, node.v - nudge);
  }
  tracer.tracer().trace(rays, Tracer::Clip::none);
  return rays;
}

/// |∂(α, β)/∂(u, v)| from a ray and its two neighbours; 0 where one of them fails.
double exit_jacobian(const RayBatch& rays, std::size_t ray, double nudge) {
  if (rays.status[ray + 1] != RayStatus::ok || rays.status[ray + 2] != RayStatus::ok) return 0;
  const double du_alpha = rays.l[ray] - rays.l[ray + 1], du_beta = rays.m[ray] - rays.m[ray + 1];
  const double dv_alpha = rays.l[ray] - rays.l[ray + 2], dv_beta = rays.m[ray] - rays.m[ray + 2];
  return std::abs(du_alpha * dv_beta - du_beta * dv_alpha) / (nudge * nudge);
}

}  // namespace

std::optional<PsfPlan> plan_psf(const FieldTracer& tracer, const ChiefRay& chief, const PsfOptions& options) {
  const std::optional<Extent> extent = scout(tracer, chief);
  if (!extent) return {};
  const double lambda_mm = tracer.tracer().wavelength_nm() * mm_per_nm / tracer.tracer().image_index();
  const double widest = std::max(extent->alpha_width, extent->beta_width);
  const double narrowest = std::min(extent->alpha_width, extent->beta_width);
  PsfPlan plan;
  plan.spacing_um =
      options.spacing_um > 0 ? options.spacing_um : spacing_per_lambda_n * lambda_mm / widest * um_per_mm;
  const double half_width_um = (extent->transverse_mm + margin_lambda_n * lambda_mm / narrowest) * um_per_mm;
  if (options.size > 0) {
    plan.size = options.size;
  } else {
    const int needed =
        size_step * static_cast<int>(std::ceil(2 * half_width_um / plan.spacing_um / size_step));
    plan.size = std::clamp(needed, smallest_size, std::max(options.largest_size, smallest_size));
  }
  const double corner_mm = std::sqrt(0.5) * plan.size * plan.spacing_um * mm_per_um;
  const double phase = 2 * pi / lambda_mm * 0.5 * widest * (corner_mm + extent->transverse_mm);
  plan.azimuths = options.azimuths > 0 ? options.azimuths : azimuths_for(phase);
  plan.radial_nodes = options.radial_nodes > 0 ? options.radial_nodes : radial_for(phase);
  return plan;
}

std::optional<PupilWaves> pupil_waves(const FieldTracer& tracer, const ChiefRay& chief, int radial_nodes,
                                      int azimuths) {
  const std::optional<PupilBoundary> pupil = tracer.object_pupil(chief, azimuths);
  if (!pupil) return {};
  const Pencil pencil = Pencil::from_object(tracer.lens(), chief.object_field);
  const double outwards = chief.image_height_mm < 0 ? -1.0 : 1.0;
  const double index = tracer.tracer().image_index();
  const double lambda_mm = tracer.tracer().wavelength_nm() * mm_per_nm;

  const std::vector<PupilNode> nodes = half_pupil_nodes(*pupil, radial_nodes);
  const double nudge = nudge_per_radius * *std::max_element(pupil->radius.begin(), pupil->radius.end());
  const RayBatch rays = trace_with_neighbours(tracer, pencil, nodes, nudge);

  PupilWaves waves;
  waves.wavelength_nm = tracer.tracer().wavelength_nm();
  waves.image_index = index;
  for (std::size_t node = 0; node < nodes.size(); ++node) {
    const std::size_t ray = rays_per_node * node;
    if (rays.status[ray] != RayStatus::ok) continue;
    const double alpha = rays.l[ray], beta = rays.m[ray];
    const double to_foot_mm = -rays.x_mm[ray] * alpha + (chief.image_height_mm - rays.y_mm[ray]) * beta;
    waves.alpha.push_back(alpha);
    waves.beta.push_back(outwards * beta);
    waves.phase_waves.push_back((rays.opl_mm[ray] + index * to_foot_mm - chief.at_image.opl_mm) / lambda_mm);
    waves.amplitude.push_back(nodes[node].weight * std::sqrt(exit_jacobian(rays, ray, nudge)));
    waves.flux += 2 * nodes[node].weight;
  }
  if (waves.size() == 0) return {};
  return waves;
}

std::optional<Psf> point_spread(const FieldTracer& tracer, const ChiefRay& chief, const PsfOptions& options) {
  const std::optional<PsfPlan> plan = plan_psf(tracer, chief, options);
  if (!plan) return {};
  const std::optional<PupilWaves> waves = pupil_waves(tracer, chief, plan->radial_nodes, plan->azimuths);
  if (!waves) return {};
  return sum_plane_waves(*waves, plan->size, plan->spacing_um);
}

}  // namespace petzval
