// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/render/media/phase_function.h>
#include <petzval/render/path.h>

#include <algorithm>

namespace petzval::render {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Path length after which weak paths are ended at random.
constexpr int roulette_depth = 2;
constexpr double roulette_floor = 0.05;
/// On so many stretches of a path, places near to lamps are looked for; later ones give little for the time.
constexpr int places_beside = 2;

}  // namespace

void PathTracer::add(Path& path, const Lanes& light, int source) const {
  const auto add_to = [&](auto& sum) {
    if (path.alone)
      sum.alone += path.throughput[path.hero] * light[path.hero];
    else
      sum.shared += path.throughput * light;
  };
  add_to(path.light);
  if (source >= 0 && !path.of_sources.empty()) add_to(path.of_sources[static_cast<std::size_t>(source)]);
}

/// What each of the skies has of light from all of them, which is asked for as one.
void PathTracer::tell_skies(Path& path, const Lanes& weight, Vector3 from, Vector3 direction,
                            int group) const {
  if (path.of_sources.empty()) return;
  for (std::size_t i = 0; i < world_.lights.environments.size(); ++i) {
    SourceLight& sum = path.of_sources[static_cast<std::size_t>(world_.lights.environment_sources[i])];
    const Lanes light =
        path.throughput * (weight * world_.lights.environments[i].radiance(from, direction, group));
    if (path.alone)
      sum.alone += light[path.hero];
    else
      sum.shared += light;
  }
}

void PathTracer::add_emitted(Path& path, const Hit& hit, const SurfacePoint& point, int group) const {
  const Geometry& geometry = world_.geometries[static_cast<std::size_t>(hit.geometry)];
  if (geometry.first_light < 0) return;
  const auto area = static_cast<std::size_t>(geometry.first_light + hit.primitive);
  const Lanes radiance = world_.lights.emitted(area, point, -path.direction, group);
  if (radiance.is_black()) return;
  double weight = 1;
  if (path.pdf > 0) {
    if (options_.lights == PathOptions::Lights::sampled) return;
    if (options_.lights == PathOptions::Lights::both)
      weight = balanced(path.pdf, path.asked_again * path.asked_mean *
                                      world_.lights.area_pdf(world_.geometries, area, path.plan, point));
  }
  add(path, weight * radiance, world_.lights.areas[area].source);
  if (path.depth == 0) path.light.straight += path.throughput * radiance;
}

void PathTracer::add_sky(Path& path, int group) const {
  if (world_.lights.environments.empty()) return;
  double weight = 1;
  if (path.pdf > 0) {
    if (options_.lights == PathOptions::Lights::sampled) return;
    if (options_.lights == PathOptions::Lights::both)
      weight = balanced(path.pdf, path.asked_mean * world_.lights.sky_pdf(path.plan, path.direction));
  }
  add(path, weight * world_.lights.sky(path.origin, path.direction, group), -1);
  tell_skies(path, weight * Lanes::all(1), path.origin, path.direction, group);
}

/// What an open way has left of a light that was asked. \param scatter_pdf  of the direction to it.
template <bool media, class Pdf>
void PathTracer::add_asked(Path& path, LightSample& light, Vector3 origin, int medium, const Lanes& f,
                           double cos, const Pdf& scatter_pdf, int group, SobolSample& sample) const {
  std::optional<Lanes> kept;  // by media
  double asked = 1, flown = 1;
  if constexpr (!media) {
    if (world_.intersector->blocked(origin, way_to(light, origin), end_of_way(light))) return;
  } else {
    const std::optional<Passage> way = open_way(path, origin, light, medium, group, sample);
    if (!way) return;
    asked = path.mean(path.led_by * way->asked), flown = path.mean(path.led_by * way->flown);
    if (!(asked > least_density)) return;
    kept = 1 / asked * way->light;
    light.light *= *kept;
  }
  double weight = cos / light.pdf;
  // In a medium, what a small ball gets: a quarter of the light from all around.
  if (path.depth == 1)
    path.light.arriving += (path.plan.to.all_around ? 0.25 / light.pdf : weight) * light.light;
  const double again = media && light.place ? path.asked_again : 1;
  weight *= light.small || options_.lights == PathOptions::Lights::sampled
                ? 1 / again
                : asked * light.pdf / (again * asked * light.pdf + flown * scatter_pdf());
  add(path, weight * (f * light.light), light.source);
  if (light.source < 0)
    tell_skies(path, weight * (kept ? f * *kept : f), path.plan.to.position, light.direction, group);
}

template <bool media>
void PathTracer::add_sampled_light(Path& path, const SurfacePoint& point, const Frame& frame,
                                   const Bsdf& bsdf, Vector3 wo, const Geometry& geometry, int group,
                                   SobolSample& sample) const {
  if (bsdf.is_mirror()) return sample.skip();
  const auto [choice, u, v] = sample.next3();
  path.plan = world_.lights.plan({point.position, wo.z < 0 ? -frame.z : frame.z, bsdf.transmits()});
  std::optional<LightSample> light = world_.lights.sample(world_.geometries, path.plan, choice, u, v, group);
  if (!light || !(light->pdf > 0)) return;
  if (options_.lights == PathOptions::Lights::by_chance && !light->small) return;
  const Vector3 wi = frame.to_local(light->direction);
  // Normals that are interpolated must not let light through from the other side.
  if ((dot(point.normal, light->direction) > 0) != (wi.z > 0)) return;
  const Lanes f = bsdf.value(wo, wi);
  if (f.is_black()) return;
  add_asked<media>(
      path, *light, point.origin_towards(light->direction),
      media ? medium_towards(geometry, point, light->direction, path.medium) : -1, f, std::abs(wi.z),
      [&] { return bsdf.pdf(wo, wi); }, group, sample);
}

template <bool media>
bool PathTracer::scatter(Path& path, const SurfacePoint& point, const Frame& frame, const Bsdf& bsdf,
                         Vector3 wo, const Geometry& geometry, SobolSample& sample) const {
  const auto [choice, u, v, roulette] = sample.next4();
  const std::optional<BsdfSample> chosen = bsdf.sample(wo, choice, u, v);
  if (!chosen || chosen->weight.is_black()) return false;
  const Vector3 direction = frame.from_local(chosen->wi);
  if ((dot(point.normal, direction) > 0) != (chosen->wi.z > 0)) return false;
  if (chosen->transmitted && bsdf.disperses()) path.leave_others();
  path.throughput *= chosen->weight;
  path.pdf = chosen->mirror ? 0 : chosen->pdf;
  if (chosen->transmitted) path.index_scale *= chosen->index_ratio * chosen->index_ratio;
  path.direction = normalised(direction);
  path.origin = point.origin_towards(path.direction);
  if constexpr (media) {
    path.medium = medium_towards(geometry, point, path.direction, path.medium);
    path.begin_stretch();
  }
  return goes_on(path, roulette);
}

bool PathTracer::scatter_in_medium(Path& path, double distance, int group, SobolSample& sample) const {
  const double g = medium_of(path, path.medium).g;
  path.origin = path.origin + distance * path.direction;
  const auto [choice, light_u, light_v] = sample.next3();
  path.plan = world_.lights.plan({.position = path.origin, .normal = path.direction, .all_around = true});
  path.asked_again = 1;
  if (path.plan.nearby_sum > 0)
    path.asked_again += path.beside * (path.plan.nearby_sum + path.plan.far_sum) / path.plan.nearby_sum;
  std::optional<LightSample> light =
      world_.lights.sample(world_.geometries, path.plan, choice, light_u, light_v, group);
  if (light && light->pdf > 0 && (options_.lights != PathOptions::Lights::by_chance || light->small)) {
    const double phase = henyey_greenstein(dot(path.direction, light->direction), g);
    add_asked<true>(
        path, *light, path.origin, path.medium, Lanes::all(phase), 1, [&] { return phase; }, group, sample);
  }
  const auto [u, v, roulette] = sample.next3();
  const Vector3 way = normalised(sample_henyey_greenstein(path.direction, g, u, v));
  path.pdf = henyey_greenstein(dot(path.direction, way), g);
  path.direction = way;
  path.begin_stretch();
  return goes_on(path, roulette);
}

/// Ends weak paths at random.
bool PathTracer::goes_on(Path& path, double roulette) const {
  const double left = static_cast<double>(path.throughput.largest()) * path.index_scale;
  if (left < 1 && path.depth > roulette_depth) {
    const double survive = std::max(roulette_floor, left);
    if (roulette >= survive) return false;
    path.throughput *= 1 / survive;
  }
  return true;
}

const Material& PathTracer::material_met(const Geometry& geometry, const TexturePoint& point, int group,
                                         SobolSample& sample) const {
  const Material& material = world_.materials[static_cast<std::size_t>(geometry.material)];
  if (material.kind != Material::Kind::mix) return material;
  return material_at(world_.materials, geometry.material, point, group, sample.next1());
}

Vector3 PathTracer::tilted_normal(const Material& material, const Geometry& geometry, const Hit& hit,
                                  const SurfacePoint& point) const {
  if (material.normal_map) return material.normal_map->normal_at(point);
  return material.bump_map->normal_at(point, along_v(geometry, hit, point, world_.place_of(hit)));
}

PathLight PathTracer::trace(Vector3 origin, Vector3 direction, int group, int hero, SobolSample& sample,
                            double limit, FirstSurface* first, std::span<SourceLight> of_sources,
                            const Lanes& led_by) const {
  Path path;
  path.origin = origin, path.direction = direction, path.hero = hero;
  path.of_sources = of_sources;
  if (world_.media.empty()) return follow<false>(path, group, sample, limit, first);
  path.medium = world_.camera_medium;
  path.begin_with(led_by, world_.groups.lanes(group));
  return follow<true>(path, group, sample, limit, first);
}

template <bool media>
PathLight PathTracer::follow(Path& path, int group, SobolSample& sample, double limit,
                             FirstSurface* first) const {
  int interfaces = 0;
  bool mirrored = true;  // so far there were only mirrors
  for (;;) {
    const std::optional<Hit> hit =
        world_.intersector->nearest(path.origin, path.direction, path.depth == 0 ? limit : infinity);
    if (media && path.medium >= 0) {
      const double distance = hit ? hit->distance : infinity;
      add_glow(path, distance, group, sample);
      std::optional<Equiangular> beside;
      if (path.depth < std::min(options_.max_depth, places_beside))
        beside = add_beside(path, distance, group, sample);
      const std::optional<double> scattered = fly(path, distance, group, sample, beside);
      const bool lost = path.throughput.is_black();
      if (first && !first->met && (scattered || lost)) {
        *first = first_beyond(path, path.depth == 0 ? limit : infinity, group, sample);
        first = nullptr;
      }
      if (lost) break;
      if (scattered) {
        if (mirrored) path.light.distance += *scattered;
        mirrored = false;
        if (path.depth++ >= options_.max_depth) break;
        if (!scatter_in_medium(path, *scattered, group, sample)) break;
        continue;
      }
    }
    if (!hit) {
      add_sky(path, group);
      if (mirrored) path.light.distance = infinity;
      break;
    }
    const Geometry& geometry = world_.geometries[static_cast<std::size_t>(hit->geometry)];
    SurfacePoint point = surface_point(geometry, *hit, path.origin, path.direction, world_.place_of(*hit));
    if (mirrored) path.light.distance += length(point.position - path.origin);
    add_emitted(path, *hit, point, group);
    const TexturePoint texture_point{point.position, point.u, point.v, point.tint};
    const Material& material = material_met(geometry, texture_point, group, sample);
    if (material.kind == Material::Kind::none) {
      if (++interfaces > most_interfaces) break;
      path.origin = point.origin_towards(path.direction);
      if (media) path.medium = medium_towards(geometry, point, path.direction, path.medium);
      continue;
    }
    if (material.normal_map || material.bump_map)
      point.shading_normal = tilted_normal(material, geometry, *hit, point);
    if (media && geometry.parts_media) enter(path, geometry, texture_point, group);
    const Bsdf bsdf = material.bsdf(texture_point, group, path.hero);
    if (first && !first->met)
      *first = {true, point.position, facing(point.shading_normal, -path.direction), bsdf.albedo()};
    mirrored = mirrored && bsdf.is_mirror();
    // A rough surface that disperses sends each wavelength its own way from here on.
    if (bsdf.disperses() && !bsdf.is_mirror()) path.leave_others();
    if (path.depth++ >= options_.max_depth) break;
    const Frame frame(point.shading_normal, point.along_u);
    const Vector3 wo = frame.to_local(-path.direction);
    if (media) path.asked_again = 1;
    add_sampled_light<media>(path, point, frame, bsdf, wo, geometry, group, sample);
    if (!scatter<media>(path, point, frame, bsdf, wo, geometry, sample)) break;
  }
  return path.light;
}

}  // namespace petzval::render
