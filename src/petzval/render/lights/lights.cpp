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

/// Directions of the normals of a triangle: its own, or both where those of its corners do not agree.
bool has_one_side(const TriangleMesh& mesh, std::size_t triangle) {
  if (mesh.normals.empty()) return true;
  const std::array<Vector3, 3> p = mesh.corners(triangle);
  const Vector3 normal = cross(p[1] - p[0], p[2] - p[0]);
  int sides = 0;
  for (const std::uint32_t corner : mesh.triangles[triangle]) {
    const TriangleMesh::Vertex& n = mesh.normals[corner];
    sides += dot(normal, Vector3{n[0], n[1], n[2]}) > 0 ? 1 : -1;
  }
  return sides == 3 || sides == -3;
}

std::array<Vector3, 2> box_about(Vector3 centre, double radius) {
  const Vector3 half{radius, radius, radius};
  return {centre - half, centre + half};
}

LightBounds bounds_of(const SmallLight& light) {
  if (light.pattern) {
    LightBounds bounds = light.pattern->bounds();
    bounds.box = {light.position, light.position};
    bounds.strength *= mean_of(light.strength);
    return bounds;
  }
  LightBounds bounds;
  bounds.box = {light.position, light.position};
  bounds.strength = mean_of(light.strength);
  bounds.spread = pi;
  if (light.kind != SmallLight::Kind::spot) return bounds;
  // Full strength up to where the edge begins; nothing beyond its end.
  const double begin = std::acos(light.cos_begin), end = std::acos(light.cos_end);
  bounds.axis = light.direction;
  bounds.spread = std::max(begin, end - pi / 2);
  bounds.reach = end - bounds.spread;
  return bounds;
}

}  // namespace

LightBounds Lights::bounds_of(const Geometry& geometry, const AreaLight& light,
                              const std::optional<Sphere>& sphere) const {
  LightBounds bounds;
  bounds.two_sided = light.two_sided;
  bounds.reach = pi / 2;
  const double radiance = mean_of(area_spectra[static_cast<std::size_t>(light.spectrum)]);
  bounds.strength = radiance * geometry.primitive_area(light.primitive);
  if (const auto* mesh = std::get_if<TriangleMesh>(&geometry.shape)) {
    const std::array<Vector3, 3> p = mesh->corners(light.primitive);
    bounds.box = {p[0], p[0]};
    for (const Vector3& corner : p)
      bounds.box = {Vector3{std::min(bounds.box[0].x, corner.x), std::min(bounds.box[0].y, corner.y),
                            std::min(bounds.box[0].z, corner.z)},
                    Vector3{std::max(bounds.box[1].x, corner.x), std::max(bounds.box[1].y, corner.y),
                            std::max(bounds.box[1].z, corner.z)}};
    bounds.radius = length(bounds.box[1] - bounds.box[0]) / 2;
    bounds.axis = sample_primitive(geometry, light.primitive, 0.5, 0.5).point.normal;
    bounds.two_sided = bounds.two_sided || !has_one_side(*mesh, light.primitive);
    return bounds;
  }
  const Quadric& quadric = std::get<Quadric>(geometry.shape);
  bounds.box = sphere ? box_about(sphere->centre, sphere->radius) : quadric.bounds();
  bounds.radius = sphere ? sphere->radius : length(bounds.box[1] - bounds.box[0]) / 2;
  if (quadric.kind == Quadric::Kind::disk) {
    bounds.axis = sample_primitive(geometry, light.primitive, 0.5, 0.5).point.normal;
    return bounds;
  }
  // Of convex bodies one sees a quarter of the surface (Cauchy).
  bounds.spread = pi;
  bounds.strength /= 4;
  return bounds;
}

void Lights::prepare(const std::vector<Geometry>& geometries) {
  std::vector<LightBounds> bounds;
  for (const AreaLight& light : areas) {
    if (bounds.size() % 4096 == 0) check_stop();
    const Geometry& geometry = geometries[static_cast<std::size_t>(light.geometry)];
    Sphere sphere;
    const auto* quadric = std::get_if<Quadric>(&geometry.shape);
    spheres_.push_back(quadric && quadric->is_round_sphere(sphere.centre, sphere.radius)
                           ? std::optional(sphere)
                           : std::nullopt);
    bounds.push_back(bounds_of(geometry, light, spheres_.back()));
  }
  for (std::size_t i = 0; i < smalls.size(); ++i) {
    if (smalls[i].kind == SmallLight::Kind::distant) {
      distant_.push_back(i);
      continue;
    }
    stands_.push_back(i);
    bounds.push_back(render::bounds_of(smalls[i]));
  }
  tree_ = LightTree(bounds);
}

namespace {

double weight_of_distant(const SmallLight& light, const LightReceiver& to) {
  if (to.all_around) return mean_of(light.strength);
  const double cos = -dot(light.direction, to.normal);
  return mean_of(light.strength) * (to.both_sides ? std::abs(cos) : std::max(0.0, cos));
}

}  // namespace

LightPlan Lights::plan(const LightReceiver& to) const {
  LightPlan plan;
  plan.to = to;
  plan.nearby_sum = tree_.weigh(to, plan.nearby);
  for (const std::size_t i : distant_) plan.far_sum += weight_of_distant(smalls[i], to);
  for (const Environment& environment : environments) plan.far_sum += environment.importance(to);
  return plan;
}

std::optional<LightSample> Lights::sample(const std::vector<Geometry>& geometries, const LightPlan& plan,
                                          double choice, double u, double v, int group) const {
  const double sum = plan.nearby_sum + plan.far_sum;
  if (!(sum > 0)) return {};
  const double nearby = plan.nearby_sum / sum;
  if (!(choice < nearby)) return sample_far(plan, choice * sum - plan.nearby_sum, u, v, group);
  const LightTree::Choice chosen = tree_.choose(plan.to, plan.nearby, plan.nearby_sum, choice / nearby);
  if (!(chosen.probability > 0)) return {};
  std::optional<LightSample> sample =
      chosen.light < areas.size()
          ? sample_area(geometries, chosen.light, plan.to.position, u, v, group)
          : sample_small(smalls[stands_[chosen.light - areas.size()]], plan.to.position, group);
  if (sample) sample->pdf *= nearby * chosen.probability;
  return sample;
}

/// \param choice  from 0 to the sum of weights.
std::optional<LightSample> Lights::sample_far(const LightPlan& plan, double choice, double u, double v,
                                              int group) const {
  const double sum = plan.nearby_sum + plan.far_sum;
  for (const std::size_t i : distant_) {
    const double weight = weight_of_distant(smalls[i], plan.to);
    choice -= weight;
    if (!(weight > 0) || choice >= 0) continue;
    std::optional<LightSample> sample = sample_small(smalls[i], plan.to.position, group);
    if (sample) sample->pdf *= weight / sum;
    return sample;
  }
  for (std::size_t i = 0; i < environments.size(); ++i) {
    choice -= environments[i].importance(plan.to);
    if (choice >= 0 && i + 1 < environments.size()) continue;
    const Environment::Sample direction = environments[i].sample(plan.to, u, v);
    if (!(direction.pdf > 0)) return {};
    // All skies shine from that direction, and each might have chosen it.
    return LightSample{direction.direction,
                       {},
                       sky(plan.to.position, direction.direction, group),
                       sky_pdf(plan, direction.direction)};
  }
  return {};
}

std::optional<LightSample> Lights::sample_small(const SmallLight& light, Vector3 to, int group) const {
  const Lanes& strength = light.strength[static_cast<std::size_t>(group)];
  if (light.kind == SmallLight::Kind::distant)
    return LightSample{-light.direction, {}, strength, 1, true, light.source};
  const Vector3 away = light.position - to;
  const double distance = length(away);
  if (!(distance > 0)) return {};
  const Vector3 direction = 1 / distance * away;
  double share = 1 / (distance * distance);
  if (light.kind == SmallLight::Kind::spot) share *= spot_share(light, -dot(direction, light.direction));
  if (!(share > 0)) return {};
  if (!light.pattern) return LightSample{direction, light.position, share * strength, 1, true, light.source};
  const Lanes sent = strength * light.pattern->share(-direction, group);
  if (sent.is_black()) return {};
  return LightSample{direction, light.position, share * sent, 1, true, light.source};
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
  return LightSample{direction, point.origin_towards(-direction), radiance, pdf, false, light.source};
}

Lanes Lights::emitted(std::size_t area, const SurfacePoint& point, Vector3 wo, int group) const {
  const AreaLight& light = areas[area];
  if (!light.two_sided && dot(point.normal, wo) <= 0) return Lanes::all(0);
  return area_spectra[static_cast<std::size_t>(light.spectrum)][static_cast<std::size_t>(group)];
}

double Lights::area_pdf(const std::vector<Geometry>& geometries, std::size_t area, const LightPlan& plan,
                        const SurfacePoint& point) const {
  const double sum = plan.nearby_sum + plan.far_sum;
  if (!(sum > 0)) return 0;
  const double share = plan.nearby_sum / sum * tree_.probability(plan.to, plan.nearby, plan.nearby_sum, area);
  const Vector3 from = plan.to.position;
  const std::optional<Sphere>& sphere = spheres_[area];
  if (sphere) {
    const double apart2 = dot(sphere->centre - from, sphere->centre - from);
    if (apart2 > sphere->radius * sphere->radius * 1.0001) {
      const double sin2_max = sphere->radius * sphere->radius / apart2;
      const double one_less_cos = sin2_max < 1e-4 ? sin2_max / 2 : 1 - std::sqrt(1 - sin2_max);
      return share / (2 * pi * one_less_cos);
    }
  }
  const AreaLight& light = areas[area];
  const Vector3 away = point.position - from;
  const double cos = std::abs(dot(normalised(away), point.normal));
  if (!(cos > 0)) return 0;
  return share *
         primitive_density(geometries[static_cast<std::size_t>(light.geometry)], light.primitive, point) *
         dot(away, away) / cos;
}

Lanes Lights::sky(const Vector3& from, const Vector3& direction, int group) const {
  Lanes sum = Lanes::all(0);
  for (const Environment& environment : environments) sum += environment.radiance(from, direction, group);
  return sum;
}

double Lights::sky_pdf(const LightPlan& plan, Vector3 direction) const {
  const double all = plan.nearby_sum + plan.far_sum;
  if (!(all > 0)) return 0;
  double sum = 0;
  for (const Environment& environment : environments)
    sum += environment.importance(plan.to) / all * environment.pdf(plan.to, direction);
  return sum;
}

}  // namespace petzval::render
