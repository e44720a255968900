// SPDX-License-Identifier: BSD-3-Clause
// The ways of paths through media.
#include <petzval/render/media/phase_function.h>
#include <petzval/render/media/varied_medium.h>
#include <petzval/render/path.h>

namespace petzval::render {

const Medium& PathTracer::medium_of(const Path& path, int medium) const {
  const Medium& here = world_.media[static_cast<std::size_t>(medium)];
  return here.varied && path.entered ? *path.entered : here;
}

void PathTracer::enter(Path& path, const Geometry& geometry, const TexturePoint& point, int group) const {
  if (geometry.inside < 0 || geometry.inside == path.medium) return;
  const Medium& below = world_.media[static_cast<std::size_t>(geometry.inside)];
  if (below.varied) path.entered = std::make_unique<const Medium>(below.varied->at(point, group));
}

std::optional<double> PathTracer::fly(Path& path, double distance, int group, SobolSample& sample,
                                      const std::optional<Equiangular>& beside) const {
  if (path.alone) path.throughput = only(path.hero, path.throughput[path.hero]);
  Lots lots(sample.next1());
  const Flight flight =
      medium_of(path, path.medium).fly(path.origin, path.direction, distance, group, path.hero, lots);
  path.led_by *= flight.passage.flown, path.asked *= flight.passage.asked;
  path.throughput *= flight.passage.light;
  const double flown = path.mean(path.led_by);
  const double over = flown > least_density ? 1 / flown : 0;
  path.led_by *= over, path.asked *= over, path.throughput *= over;
  path.asked_mean = path.mean(path.asked);
  path.beside = beside && flight.scattered_at ? beside->density(*flight.scattered_at) * over : 0;
  return flight.scattered_at;
}

void PathTracer::add_glow(Path& path, double distance, int group, SobolSample& sample) const {
  const Medium& medium = medium_of(path, path.medium);
  if (!medium.emission) return;
  Lots lots(medium.density ? sample.next1() : 0);
  const Lanes light = medium.glow(path.origin, path.direction, distance, group, lots);
  add(path, light, medium.emission->source);
  if (path.depth == 0) path.light.straight += path.throughput * light;
}

std::optional<Equiangular> PathTracer::add_beside(Path& path, double distance, int group,
                                                  SobolSample& sample) const {
  const Medium& medium = medium_of(path, path.medium);
  if (medium.density || !medium.scatters || options_.lights == PathOptions::Lights::by_chance) return {};
  const auto [which, where, choice] = sample.next3();
  const auto [u, v] = sample.next2();
  const auto extinction = static_cast<double>(medium.extinction(group)[path.hero]);
  const std::optional<Equiangular> beside =
      world_.lights.beside({path.origin, path.direction, distance, extinction, medium.angle_shares}, which);
  if (!beside) return {};
  const double at = beside->sample(where);
  if (!(at > 0 && at < distance)) return beside;
  const Vector3 place = path.origin + at * path.direction;
  LightPlan plan = world_.lights.plan({.position = place, .normal = path.direction, .all_around = true});
  const double nearby = plan.nearby_sum / (plan.nearby_sum + plan.far_sum);
  plan.far_sum = 0;
  const std::optional<LightSample> light = world_.lights.sample(world_.geometries, plan, choice, u, v, group);
  if (!light || !(light->pdf > 0)) return beside;
  const std::optional<Passage> way = open_way(path, place, *light, path.medium, group, sample);
  if (!way) return beside;
  const double asked = path.mean(path.led_by * way->asked), density = beside->density(at);
  if (!(asked > least_density)) return beside;
  // The other ways of finding the light: from where the path may be scattered, asked or by chance.
  const Passage there = medium.scattered_at(at, group).passage;
  const Lanes led_by = path.led_by * there.flown;
  const double phase = henyey_greenstein(dot(path.direction, light->direction), medium.g);
  const double flown = path.mean(led_by), flown_and_asked = path.mean(led_by * way->asked);
  const double share = flown > least_density ? flown_and_asked / flown : asked;
  double sum = light->pdf * (density * share + nearby * flown_and_asked);
  if (!light->small && options_.lights == PathOptions::Lights::both)
    sum += phase * path.mean(led_by * way->flown);
  add(path, share / asked * phase / sum * (there.light * way->light * light->light), light->source);
  return beside;
}

std::optional<Passage> PathTracer::open_way(const Path& path, Vector3 origin, const LightSample& light,
                                            int medium, int group, SobolSample& sample) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (!world_.media_end_openly && medium < 0) {
    if (world_.intersector->blocked(origin, way_to(light, origin), end_of_way(light))) return {};
    return Passage();
  }
  Lots lots(sample.next1());
  Passage passage;
  for (int i = 0; i < most_interfaces; ++i) {
    const Vector3 way = way_to(light, origin);
    const double length_of_way = light.place ? length(way) : 1;
    const std::optional<Hit> hit = world_.intersector->nearest(origin, way, end_of_way(light));
    const Geometry* geometry = hit ? &world_.geometries[static_cast<std::size_t>(hit->geometry)] : nullptr;
    if (geometry && !geometry->is_interface) return {};
    if (medium >= 0) {
      const double distance = hit ? hit->distance * length_of_way : light.place ? length_of_way : infinity;
      passage *= medium_of(path, medium).pass(origin, normalised(way), distance, group, path.hero, lots);
    }
    if (!geometry) return passage;
    const SurfacePoint point = surface_point(*geometry, *hit, origin, way, world_.place_of(*hit));
    medium = medium_towards(*geometry, point, way, medium);
    origin = point.origin_towards(light.direction);
  }
  return {};
}

FirstSurface PathTracer::first_beyond(const Path& path, double limit, int group, SobolSample& sample) const {
  Vector3 origin = path.origin;
  for (int i = 0; i < most_interfaces; ++i) {
    const std::optional<Hit> hit = world_.intersector->nearest(origin, path.direction, limit);
    if (!hit) return {};
    const Geometry& geometry = world_.geometries[static_cast<std::size_t>(hit->geometry)];
    SurfacePoint point = surface_point(geometry, *hit, origin, path.direction, world_.place_of(*hit));
    const TexturePoint texture_point{point.position, point.u, point.v, point.tint};
    const Material& material = material_met(geometry, texture_point, group, sample);
    if (material.kind != Material::Kind::none) {
      if (material.normal_map || material.bump_map)
        point.shading_normal = tilted_normal(material, geometry, *hit, point);
      return {true, point.position, facing(point.shading_normal, -path.direction),
              material.bsdf(texture_point, group, path.hero).albedo()};
    }
    origin = point.origin_towards(path.direction);
  }
  return {};
}

}  // namespace petzval::render
