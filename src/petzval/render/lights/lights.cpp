// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/stop.h>
#include <petzval/base/units.h>
#include <petzval/render/lights/lights.h>

#include <algorithm>

namespace petzval::render {

namespace {

/// 1 inside of the cone, 0 outside, smooth between (pbrt-v4).
double spot_share(const SmallLight& light, double cos) {
  if (cos >= light.cos_begin) return 1;
  if (cos <= light.cos_end) return 0;
  const double x = (cos - light.cos_end) / (light.cos_begin - light.cos_end);
  return x * x * (3 - 2 * x);
}

double power_of(const SmallLight& light, double scene_radius) {
  const double strength = mean_of(light.strength);
  if (light.kind == SmallLight::Kind::distant) return strength * pi * scene_radius * scene_radius;
  if (light.kind == SmallLight::Kind::spot)
    return strength * 2 * pi * (1 - (light.cos_begin + light.cos_end) / 2);
  return strength * 4 * pi;
}

}  // namespace

void Lights::prepare(const std::vector<Geometry>& geometries, double scene_radius) {
  std::vector<double> powers;
  for (const AreaLight& light : areas) {
    if (powers.size() % 4096 == 0) check_stop();
    const Geometry& geometry = geometries[static_cast<std::size_t>(light.geometry)];
    powers.push_back(mean_of(area_spectra[static_cast<std::size_t>(light.spectrum)]) * pi *
                     (light.two_sided ? 2 : 1) * geometry.primitive_area(light.primitive));
    Sphere sphere;
    const auto* quadric = std::get_if<Quadric>(&geometry.shape);
    spheres_.push_back(quadric && quadric->is_round_sphere(sphere.centre, sphere.radius)
                           ? std::optional(sphere)
                           : std::nullopt);
  }
  for (const SmallLight& light : smalls) powers.push_back(power_of(light, scene_radius));
  for (const Environment& light : environments)
    powers.push_back(light.mean() * 4 * pi * pi * scene_radius * scene_radius);
  double sum = 0;
  for (const double power : powers) sum += power;
  // A light of little power far away may be all that a point sees: none is left out.
  cumulative_.assign(1, 0.0);
  const auto count = static_cast<double>(powers.size());
  for (const double power : powers)
    cumulative_.push_back(cumulative_.back() + (sum > 0 ? 0.9 * power / sum + 0.1 / count : 1 / count));
  const double end = cumulative_.back();
  for (double& each : cumulative_) each /= end > 0 ? end : 1;
}

std::optional<LightSample> Lights::sample(const std::vector<Geometry>& geometries, Vector3 to, double choice,
                                          double u, double v, int group) const {
  if (empty()) return {};
  const auto above = std::upper_bound(cumulative_.begin() + 1, cumulative_.end(), choice);
  const std::size_t light =
      std::min(static_cast<std::size_t>(above - cumulative_.begin()) - 1, cumulative_.size() - 2);
  std::optional<LightSample> sample;
  if (light < areas.size()) {
    sample = sample_area(geometries, light, to, u, v, group);
  } else if (light < areas.size() + smalls.size()) {
    sample = sample_small(smalls[light - areas.size()], to, group);
  } else {
    const Environment& environment = environments[light - areas.size() - smalls.size()];
    const Environment::Sample direction = environment.sample(u, v);
    if (!(direction.pdf > 0)) return {};
    // All skies shine from that direction, and each might have chosen it.
    return LightSample{
        direction.direction, {}, sky(direction.direction, group), sky_pdf(direction.direction)};
  }
  if (sample) sample->pdf *= share(light);
  return sample;
}

std::optional<LightSample> Lights::sample_small(const SmallLight& light, Vector3 to, int group) const {
  const Lanes& strength = light.strength[static_cast<std::size_t>(group)];
  if (light.kind == SmallLight::Kind::distant) return LightSample{-light.direction, {}, strength, 1, true};
  const Vector3 away = light.position - to;
  const double distance = length(away);
  if (!(distance > 0)) return {};
  const Vector3 direction = 1 / distance * away;
  double share = 1 / (distance * distance);
  if (light.kind == SmallLight::Kind::spot) share *= spot_share(light, -dot(direction, light.direction));
  if (!(share > 0)) return {};
  return LightSample{direction, light.position, share * strength, 1, true};
}

std::optional<LightSample> Lights::sample_area(const std::vector<Geometry>& geometries, std::size_t index,
                                               Vector3 to, double u, double v, int group) const {
  const AreaLight& light = areas[index];
  const Geometry& geometry = geometries[static_cast<std::size_t>(light.geometry)];
  SurfacePoint point;
  double pdf;
  const std::optional<Sphere>& sphere = spheres_[index];
  const double apart2 = sphere ? dot(sphere->centre - to, sphere->centre - to) : 0;
  if (sphere && apart2 > sphere->radius * sphere->radius * 1.0001) {
    // Even over the cone that the sphere fills; 1 − cos without cancellation when it is far away.
    const double sin2_max = sphere->radius * sphere->radius / apart2;
    const double one_less_cos = sin2_max < 1e-4 ? sin2_max / 2 : 1 - std::sqrt(1 - sin2_max);
    const double cos = 1 - u * one_less_cos, sin2 = std::max(0.0, 1 - cos * cos), phi = 2 * pi * v;
    const Frame frame(normalised(sphere->centre - to));
    const Vector3 direction =
        frame.from_local({std::sqrt(sin2) * std::cos(phi), std::sqrt(sin2) * std::sin(phi), cos});
    const double apart = std::sqrt(apart2);
    const double along =
        apart * cos - std::sqrt(std::max(0.0, sphere->radius * sphere->radius - apart2 * sin2));
    point.position = to + along * direction;
    point.normal = normalised(point.position - sphere->centre);
    if (geometry.reversed) point.normal = -point.normal;
    pdf = 1 / (2 * pi * one_less_cos);
  } else {
    const SurfaceSample on = sample_primitive(geometry, light.primitive, u, v);
    point = on.point;
    const Vector3 away = point.position - to;
    const double cos = std::abs(dot(normalised(away), point.normal));
    if (!(cos > 0)) return {};
    pdf = on.per_area * dot(away, away) / cos;
  }
  const Vector3 away = point.position - to;
  const double distance = length(away);
  if (!(distance > 0) || !std::isfinite(pdf)) return {};
  const Vector3 direction = 1 / distance * away;
  const Lanes radiance = emitted(index, point, -direction, group);
  if (radiance.is_black()) return {};
  return LightSample{direction, point.origin_towards(-direction), radiance, pdf};
}

Lanes Lights::emitted(std::size_t area, const SurfacePoint& point, Vector3 wo, int group) const {
  const AreaLight& light = areas[area];
  if (!light.two_sided && dot(point.normal, wo) <= 0) return Lanes::all(0);
  return area_spectra[static_cast<std::size_t>(light.spectrum)][static_cast<std::size_t>(group)];
}

double Lights::area_pdf(const std::vector<Geometry>& geometries, std::size_t area, Vector3 from,
                        const SurfacePoint& point) const {
  const std::optional<Sphere>& sphere = spheres_[area];
  if (sphere) {
    const double apart2 = dot(sphere->centre - from, sphere->centre - from);
    if (apart2 > sphere->radius * sphere->radius * 1.0001) {
      const double sin2_max = sphere->radius * sphere->radius / apart2;
      const double one_less_cos = sin2_max < 1e-4 ? sin2_max / 2 : 1 - std::sqrt(1 - sin2_max);
      return share(area) / (2 * pi * one_less_cos);
    }
  }
  const AreaLight& light = areas[area];
  const Vector3 away = point.position - from;
  const double cos = std::abs(dot(normalised(away), point.normal));
  if (!(cos > 0)) return 0;
  return share(area) *
         primitive_density(geometries[static_cast<std::size_t>(light.geometry)], light.primitive, point) *
         dot(away, away) / cos;
}

Lanes Lights::sky(Vector3 direction, int group) const {
  Lanes sum = Lanes::all(0);
  for (const Environment& environment : environments) sum += environment.radiance(direction, group);
  return sum;
}

double Lights::sky_pdf(Vector3 direction) const {
  double sum = 0;
  for (std::size_t i = 0; i < environments.size(); ++i)
    sum += share(areas.size() + smalls.size() + i) * environments[i].pdf(direction);
  return sum;
}

}  // namespace petzval::render
