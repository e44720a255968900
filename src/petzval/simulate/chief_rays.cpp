// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/simulate/chief_rays.h>

namespace petzval {

namespace {

/// Surfaces that are no boundary, one behind the other, after which the way is taken to be free.
constexpr int most_seen_through = 1000;

}  // namespace

render::SceneCamera camera_through_the_middle(const PreparedScene& scene) {
  render::SceneCamera camera = scene_camera(scene);
  if (camera.lens)
    camera.lens->aperture = {Aperture::Kind::stop_semi_diameter_mm,
                             middle_share_of_stop * stop_radius_mm(*camera.lens)};
  camera.perspective.lens_radius = 0;
  return camera;
}

ChiefRays::ChiefRays(const PreparedScene& scene)
    : world_(world_for_focus(scene)),
      camera_(camera_through_the_middle(scene)),
      window_(camera_.crop.value_or(render::PixelWindow{0, 0, camera_.film.columns, camera_.film.rows})),
      film_camera_(camera_.make(world_.groups)),
      sampling_(window_) {}

render::Transform ChiefRays::world_from_camera(double row) const {
  return camera_.motion ? camera_.motion->world_from_camera(camera_.motion->opens(row, camera_.film.rows))
                        : camera_.world_from_camera;
}

std::vector<render::CameraRay> ChiefRays::trace(const std::vector<std::array<double, 2>>& places) const {
  std::vector<render::FilmSample> samples(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) samples[i] = {places[i][0], places[i][1], 0.5, 0.5};
  std::vector<render::CameraRay> rays(samples.size());
  film_camera_->trace(0, sampling_, samples, rays);
  return rays;
}

std::vector<render::CameraRay> ChiefRays::trace_row(int row) const {
  std::vector<std::array<double, 2>> places;
  for (int column = window_.left; column < window_.right; ++column)
    places.push_back({column + 0.5, window_.top + row + 0.5});
  return trace(places);
}

std::optional<SeenPoint> ChiefRays::seen(const render::CameraRay& ray, const render::Transform& from) const {
  if (!ray.passes) return {};
  const auto part = camera_.clipping.part_of(ray.origin, ray.direction);
  if (!(part.to > part.from)) return {};
  const render::Vector3 direction = from.direction(ray.direction);
  render::Vector3 origin = from.point(ray.origin + part.from * ray.direction);
  double limit = part.to - part.from;
  for (int i = 0; i < most_seen_through; ++i) {
    const auto hit = world_.intersector->nearest(origin, direction, limit);
    if (!hit) return {};
    const render::Geometry& geometry = world_.geometries[static_cast<std::size_t>(hit->geometry)];
    const render::SurfacePoint point =
        surface_point(geometry, *hit, origin, direction, world_.place_of(*hit));
    if (!geometry.is_interface) return SeenPoint{*hit, point.position};
    origin = point.origin_towards(direction);
    limit -= hit->distance;
  }
  return {};
}

}  // namespace petzval
