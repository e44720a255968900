// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/analysis/pupil_mask.h>
#include <petzval/analysis/pupil_rays.h>
#include <petzval/base/units.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace petzval {

namespace {

/// Distance to neighbouring rays per pupil radius: the central difference errs by its square, 1e-8, and
/// rounding by 1e-12.
constexpr double opd_nudge_per_radius = 1e-4;

class Launcher {
 public:
  Launcher(const FieldTracer& tracer, const ChiefRay& chief)
      : tracer_(tracer), chief_(chief), pencil_(Pencil::from_object(tracer.lens(), chief.object_field)) {}

  Tracer::Clearance trace(double u, double v) const {
    return pencil_.clearance(tracer_.tracer(), u, v, Tracer::Clip::none);
  }
  static bool arrived(const Tracer::Clearance& traced) {
    return traced.reached_stop && traced.ray.status == RayStatus::ok && std::isfinite(traced.worst);
  }
  bool is_dark(double u, double v) const { return is_obscured(tracer_, *pencil_.ray(u, v)); }
  PupilRay at_image(const Tracer::Clearance& traced) const {
    const Ray& ray = traced.ray;
    PupilRay result;
    result.stop_x_mm = traced.stop_x_mm;
    result.stop_y_mm = traced.stop_y_mm;
    result.x_mm = ray.point_mm[0] - chief_.image_x_mm;
    result.y_mm = ray.point_mm[1] - chief_.image_height_mm;
    result.alpha = ray.direction[0];
    result.beta = ray.direction[1];
    result.path_mm = ray.opl_mm - chief_.at_image.opl_mm;
    return result;
  }

  /// Sets the three weights of a node from its four neighbours; false where one of them fails.
  bool weigh(const PupilNode& node, double nudge, PupilRay& ray) const {
    const Tracer::Clearance right = trace(node.u + nudge, node.v), left = trace(node.u - nudge, node.v),
                            above = trace(node.u, node.v + nudge), below = trace(node.u, node.v - nudge);
    for (const Tracer::Clearance* each : {&right, &left, &above, &below})
      if (!arrived(*each)) return false;
    const auto area = [&](auto&& x, auto&& y) {
      return std::abs((x(right) - x(left)) * (y(above) - y(below)) -
                      (y(right) - y(left)) * (x(above) - x(below))) /
             (4 * nudge * nudge);
    };
    ray.entrance_measure = node.weight;
    ray.stop_area_mm2 = ray.entrance_measure * area([](const auto& at) { return at.stop_x_mm; },
                                                    [](const auto& at) { return at.stop_y_mm; });
    ray.exit_solid_angle_sr = ray.entrance_measure * area([](const auto& at) { return at.ray.direction[0]; },
                                                          [](const auto& at) { return at.ray.direction[1]; });
    return true;
  }

 private:
  const FieldTracer& tracer_;
  const ChiefRay& chief_;
  Pencil pencil_;
};

/// Rays of the nodes inside a boundary that arrive. \param weigh  sets their weights; false leaves one out.
template <class Weigh>
std::vector<PupilRay> node_rays(const Launcher& launcher, const PupilBoundary& pupil, int radial_nodes,
                                Weigh&& weigh) {
  std::vector<PupilRay> rays;
  for (const PupilNode& node : pupil_nodes(pupil, radial_nodes)) {
    const Tracer::Clearance traced = launcher.trace(node.u, node.v);
    if (!Launcher::arrived(traced) || launcher.is_dark(node.u, node.v)) continue;
    PupilRay ray = launcher.at_image(traced);
    ray.mirrored = pupil.mirrored();
    if (weigh(node, ray)) rays.push_back(ray);
  }
  return rays;
}

}  // namespace

std::vector<PupilRay> pupil_rays(const FieldTracer& tracer, const ChiefRay& chief,
                                 const PupilSampling& sampling) {
  const std::optional<PupilBoundary> pupil = tracer.object_pupil(chief, sampling.azimuths);
  if (!pupil) return {};
  const Launcher launcher(tracer, chief);
  const double nudge = opd_nudge_per_radius * *std::max_element(pupil->radius.begin(), pupil->radius.end());
  std::vector<PupilRay> rays =
      node_rays(launcher, *pupil, sampling.radial_nodes,
                [&](const PupilNode& node, PupilRay& ray) { return launcher.weigh(node, nudge, ray); });
  if (rays.empty()) return rays;
  for (std::size_t i = 0; i < pupil->own(); ++i) {
    const auto [u, v] = pupil->rim(i);
    const Tracer::Clearance traced = launcher.trace(u, v);
    if (!Launcher::arrived(traced)) continue;
    rays.push_back(launcher.at_image(traced));
    rays.back().mirrored = pupil->mirrored();
  }
  return rays;
}

std::vector<PupilRay> light_rays(const FieldTracer& tracer, const ChiefRay& chief,
                                 const PupilSampling& sampling) {
  const std::optional<PupilBoundary> pupil = tracer.object_pupil(chief, sampling.azimuths);
  if (!pupil) return {};
  return node_rays(Launcher(tracer, chief), *pupil, sampling.radial_nodes,
                   [](const PupilNode& node, PupilRay& ray) {
                     ray.entrance_measure = node.weight;
                     return true;
                   });
}

namespace {

/// The rim of a pupil by how much of its area lies before an azimuth.
class RimByArea {
 public:
  explicit RimByArea(const PupilBoundary& pupil) : pupil_(pupil), before_{0} {
    for (std::size_t i = 0; i < pupil.radius.size(); ++i)
      before_.push_back(before_.back() + 0.5 * pupil.radius[i] * pupil.radius[i] * pupil.azimuth_weight(i));
  }

  /// The rim where this share of the area, counted from +v towards +u, lies before it, as (u, v) − centre.
  std::pair<double, double> at(double share) const {
    const double area = share * before_.back();
    const auto next = std::upper_bound(before_.begin() + 1, before_.end() - 1, area);
    const auto i = static_cast<std::size_t>(next - before_.begin()) - 1;
    const double place = static_cast<double>(i) + (area - before_[i]) / (before_[i + 1] - before_[i]);
    const double azimuth = azimuth_at(place);
    // Radii stand in the middle of their samples.
    const std::size_t count = pupil_.radius.size();
    const double middle = place - 0.5 + static_cast<double>(count), below = std::floor(middle);
    const auto low = static_cast<std::size_t>(below);
    const double part = middle - below;
    const double radius = (1 - part) * pupil_.radius[low % count] + part * pupil_.radius[(low + 1) % count];
    return {radius * std::sin(azimuth), radius * std::cos(azimuth)};
  }

 private:
  double azimuth_at(double place) const {
    const std::size_t count = pupil_.radius.size();
    double turn = 2 * pi * place / static_cast<double>(count);
    if (!pupil_.mirrored()) {  // nodes of a quadrature: their weights are how far each reaches
      const auto i = std::min(static_cast<std::size_t>(place), count - 1);
      turn = pupil_.turns[i] + (place - static_cast<double>(i) - 0.5) * pupil_.turn_weights[i];
    }
    return std::atan2(pupil_.stretch * std::sin(turn), std::cos(turn));
  }

  const PupilBoundary& pupil_;
  std::vector<double> before_;
};

}  // namespace

std::vector<PupilRay> ring_rays(const FieldTracer& tracer, const ChiefRay& chief, int rings) {
  constexpr int azimuths = 512;
  std::vector<PupilRay> rays;
  const Launcher launcher(tracer, chief);
  const std::optional<PupilBoundary> pupil = tracer.object_pupil(chief, azimuths);
  if (!pupil) return rays;
  const RimByArea rim(*pupil);
  for (int ring = 1; ring <= rings; ++ring)
    for (int i = 0; i < 6 * ring; ++i) {
      const auto [u, v] = rim.at((i + 0.5) / (6 * ring));
      const double share = (ring - 0.5) / (rings - 0.5);
      const double at_u = pupil->centre_u + share * u, at_v = pupil->centre_v + share * v;
      const Tracer::Clearance traced = launcher.trace(at_u, at_v);
      if (Launcher::arrived(traced) && !launcher.is_dark(at_u, at_v))
        rays.push_back(launcher.at_image(traced));
    }
  return rays;
}

double exit_solid_angle_sr(const FieldTracer& tracer, const std::vector<PupilRay>& rays) {
  const double index = tracer.tracer().image_index();
  double sum = 0;
  for (const PupilRay& ray : rays) sum += ray.exit_solid_angle_sr;
  return index * index * sum;
}

}  // namespace petzval
