// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/base/stop.h>
#include <petzval/simulate/prepared_world.h>
#include <petzval/simulate/scene_segments.h>

#include <algorithm>

namespace petzval {

namespace {

constexpr double middle_share_of_stop = 0.02;
/// Surfaces that are no boundary, one behind the other, after which the way is taken to be free.
constexpr int most_seen_through = 1000;

render::SceneCamera camera_through_the_middle(const PreparedScene& scene) {
  render::SceneCamera camera = scene_camera(scene);
  if (camera.lens)
    camera.lens->aperture = {Aperture::Kind::stop_semi_diameter_mm,
                             middle_share_of_stop * stop_radius_mm(*camera.lens)};
  camera.perspective.lens_radius = 0;
  return camera;
}

std::optional<render::Hit> first_boundary(const render::World& world, render::Vector3 origin,
                                          render::Vector3 direction, double limit) {
  for (int i = 0; i < most_seen_through; ++i) {
    const auto hit = world.intersector->nearest(origin, direction, limit);
    if (!hit || !world.geometries[static_cast<std::size_t>(hit->geometry)].is_interface) return hit;
    const render::SurfacePoint point =
        surface_point(world.geometries[static_cast<std::size_t>(hit->geometry)], *hit, origin, direction,
                      world.place_of(*hit));
    origin = point.origin_towards(direction);
    limit -= hit->distance;
  }
  return {};
}

}  // namespace

SceneSegments segments_seen(const PreparedScene& scene, const Context& context) {
  const render::World& world = world_for_focus(scene);
  const render::SceneCamera set_up = camera_through_the_middle(scene);
  const render::PixelWindow window =
      set_up.crop.value_or(render::PixelWindow{0, 0, set_up.film.columns, set_up.film.rows});
  const auto camera = set_up.make(world.groups);
  const render::FilmSampling sampling(window);
  SceneSegments seen{window.columns(), window.rows(), {}, {}, {}};
  for (std::vector<int>* each : {&seen.shape, &seen.instance, &seen.material})
    each->assign(window.size(), -1);
  const auto row_of = [&](std::size_t row) {
    check_stop();
    std::vector<render::FilmSample> samples(static_cast<std::size_t>(window.columns()));
    for (std::size_t i = 0; i < samples.size(); ++i)
      samples[i] = {window.left + static_cast<double>(i) + 0.5, window.top + static_cast<double>(row) + 0.5,
                    0.5, 0.5};
    std::vector<render::CameraRay> rays(samples.size());
    camera->trace(0, sampling, samples, rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (!rays[i].passes) continue;
      const auto part = set_up.clipping.part_of(rays[i].origin, rays[i].direction);
      if (!(part.to > part.from)) continue;
      const render::Vector3 along = set_up.world_from_camera.direction(rays[i].direction);
      const auto hit = first_boundary(
          world, set_up.world_from_camera.point(rays[i].origin + part.from * rays[i].direction), along,
          part.to - part.from);
      if (!hit) continue;
      const std::size_t at = row * samples.size() + i;
      seen.shape[at] = hit->geometry, seen.instance[at] = hit->instance;
      seen.material[at] = world.geometries[static_cast<std::size_t>(hit->geometry)].material;
    }
  };
  run_within(context,
             [&](const ProgressCallback&) { parallel_for(static_cast<std::size_t>(window.rows()), row_of); });
  return seen;
}

}  // namespace petzval
