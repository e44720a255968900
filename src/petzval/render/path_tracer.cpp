// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/render/path_tracer.h>

#include <algorithm>

namespace petzval::render {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Paths through surfaces that are no boundary do not count as scattered; this many are enough for any scene.
constexpr int most_interfaces = 1000;
/// Share of a shadow ray's way on which it may be blocked: to the last roundings of a float.
constexpr double shadow_end = 1 - 0x1p-20;
/// Path length after which weak paths are ended at random.
constexpr int roulette_depth = 2;
constexpr double roulette_floor = 0.05;

/// Share of one of two ways of sampling that could both have found a path (balance heuristic, Veach 1997).
double balanced(double pdf, double other) {
  return pdf / (pdf + other);
}

}  // namespace

struct PathTracer::Path {
  Vector3 origin, direction;
  Lanes throughput = Lanes::all(1);
  double pdf = 0;      ///< of the last scattering; 0 after a mirror or at the camera
  bool alone = false;  ///< dispersed: only the hero wavelength is left
  int hero = 0, depth = 0;
  double index_scale = 1;  ///< what refraction has done to radiance so far, undone for Russian roulette
  LightPlan plan;          ///< of the last surface that is no mirror
  std::span<SourceLight> of_sources;
  PathLight light;
};

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
void PathTracer::tell_skies(Path& path, const Lanes& weight, Vector3 direction, int group) const {
  if (path.of_sources.empty()) return;
  for (std::size_t i = 0; i < world_.lights.environments.size(); ++i) {
    SourceLight& sum = path.of_sources[static_cast<std::size_t>(world_.lights.environment_sources[i])];
    const Lanes light = path.throughput * (weight * world_.lights.environments[i].radiance(direction, group));
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
      weight = balanced(path.pdf, world_.lights.area_pdf(world_.geometries, area, path.plan, point));
  }
  add(path, weight * radiance, world_.lights.areas[area].source);
  if (path.depth == 0) path.light.straight += radiance;
}

void PathTracer::add_sky(Path& path, int group) const {
  if (world_.lights.environments.empty()) return;
  double weight = 1;
  if (path.pdf > 0) {
    if (options_.lights == PathOptions::Lights::sampled) return;
    if (options_.lights == PathOptions::Lights::both)
      weight = balanced(path.pdf, world_.lights.sky_pdf(path.plan, path.direction));
  }
  add(path, weight * world_.lights.sky(path.direction, group), -1);
  tell_skies(path, weight * Lanes::all(1), path.direction, group);
}

void PathTracer::add_sampled_light(Path& path, const SurfacePoint& point, const Frame& frame,
                                   const Bsdf& bsdf, Vector3 wo, int group, SobolSample& sample) const {
  if (bsdf.is_mirror()) return sample.skip();
  const auto [choice, u, v] = sample.next3();
  path.plan = world_.lights.plan({point.position, wo.z < 0 ? -frame.z : frame.z, bsdf.transmits()});
  const std::optional<LightSample> light =
      world_.lights.sample(world_.geometries, path.plan, choice, u, v, group);
  if (!light || !(light->pdf > 0)) return;
  if (options_.lights == PathOptions::Lights::by_chance && !light->small) return;
  const Vector3 wi = frame.to_local(light->direction);
  // Normals that are interpolated must not let light through from the other side.
  if ((dot(point.normal, light->direction) > 0) != (wi.z > 0)) return;
  const Lanes f = bsdf.value(wo, wi);
  if (f.is_black()) return;
  const Vector3 origin = point.origin_towards(light->direction);
  // Between two places, each just in front of its surface: at grazing angles a direction alone would miss by
  // much.
  const Vector3 way = light->place ? *light->place - origin : light->direction;
  if (world_.intersector->blocked(origin, way, light->place ? shadow_end : infinity)) return;
  double weight = std::abs(wi.z) / light->pdf;
  if (path.depth == 1) path.light.arriving += weight * light->light;
  if (!light->small && options_.lights == PathOptions::Lights::both)
    weight *= balanced(light->pdf, bsdf.pdf(wo, wi));
  add(path, weight * (f * light->light), light->source);
  if (light->source < 0) tell_skies(path, weight * f, light->direction, group);
}

bool PathTracer::scatter(Path& path, const SurfacePoint& point, const Frame& frame, const Bsdf& bsdf,
                         Vector3 wo, int hero, SobolSample& sample) const {
  const auto [choice, u, v, roulette] = sample.next4();
  const std::optional<BsdfSample> chosen = bsdf.sample(wo, choice, u, v);
  if (!chosen || chosen->weight.is_black()) return false;
  const Vector3 direction = frame.from_local(chosen->wi);
  if ((dot(point.normal, direction) > 0) != (chosen->wi.z > 0)) return false;
  if (chosen->transmitted && bsdf.disperses() && !path.alone) path.alone = true;
  path.hero = hero;
  path.throughput *= chosen->weight;
  path.pdf = chosen->mirror ? 0 : chosen->pdf;
  if (chosen->transmitted) path.index_scale *= chosen->index_ratio * chosen->index_ratio;
  path.direction = normalised(direction);
  path.origin = point.origin_towards(path.direction);
  const double left = static_cast<double>(path.throughput.largest()) * path.index_scale;
  if (left < 1 && path.depth > roulette_depth) {
    const double survive = std::max(roulette_floor, left);
    if (roulette >= survive) return false;
    path.throughput *= 1 / survive;
  }
  return true;
}

PathLight PathTracer::trace(Vector3 origin, Vector3 direction, int group, int hero, SobolSample& sample,
                            double limit, FirstSurface* first, std::span<SourceLight> of_sources) const {
  Path path;
  path.origin = origin, path.direction = direction, path.hero = hero;
  path.of_sources = of_sources;
  int interfaces = 0;
  bool mirrored = true;  // so far there were only mirrors
  for (;;) {
    const std::optional<Hit> hit =
        world_.intersector->nearest(path.origin, path.direction, path.depth == 0 ? limit : infinity);
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
    const Material& material =
        world_.materials[static_cast<std::size_t>(geometry.material)].kind == Material::Kind::mix
            ? material_at(world_.materials, geometry.material, texture_point, group, sample.next1())
            : world_.materials[static_cast<std::size_t>(geometry.material)];
    if (material.kind == Material::Kind::none) {
      if (++interfaces > most_interfaces) break;
      path.origin = point.origin_towards(path.direction);
      continue;
    }
    if (material.normal_map) point.shading_normal = material.normal_map->normal_at(point);
    const Bsdf bsdf = material.bsdf(texture_point, group, hero);
    if (first && !first->met)
      *first = {true, point.position, facing(point.shading_normal, -path.direction), bsdf.albedo()};
    mirrored = mirrored && bsdf.is_mirror();
    // A rough surface that disperses sends each wavelength its own way from here on.
    if (bsdf.disperses() && !bsdf.is_mirror()) path.alone = true;
    if (path.depth++ >= options_.max_depth) break;
    const Frame frame(point.shading_normal, point.along_u);
    const Vector3 wo = frame.to_local(-path.direction);
    add_sampled_light(path, point, frame, bsdf, wo, group, sample);
    if (!scatter(path, point, frame, bsdf, wo, hero, sample)) break;
  }
  return path.light;
}

}  // namespace petzval::render
