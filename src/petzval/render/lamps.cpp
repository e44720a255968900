// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/render/lamps.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval::render {

namespace {

/// About a shape, from places all over its primitives.
Lamp ball_about(const Geometry& geometry) {
  Lamp ball;
  if (const auto* quadric = std::get_if<Quadric>(&geometry.shape))
    if (quadric->is_round_sphere(ball.centre, ball.radius)) return ball;
  constexpr double infinite = std::numeric_limits<double>::infinity();
  Vector3 low{infinite, infinite, infinite}, high = -low;
  const auto each_place = [&](const auto& visit) {
    for (std::size_t primitive = 0; primitive < geometry.primitives(); ++primitive)
      for (const double u : {0.0, 0.25, 0.5, 0.75, 1.0})
        for (const double v : {0.0, 0.25, 0.5, 0.75, 1.0})
          visit(sample_primitive(geometry, primitive, u, v).point.position);
  };
  each_place([&](Vector3 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  });
  ball.centre = 0.5 * (low + high);
  each_place([&](Vector3 p) { ball.radius = std::max(ball.radius, length(p - ball.centre)); });
  return ball;
}

}  // namespace

std::vector<Lamp> lamps_of(const World& world, const Transform& world_from_camera) {
  constexpr double most_slope = 5;  // about 79 degrees from the axis
  std::vector<Lamp> lamps;
  for (const Geometry& geometry : world.geometries) {
    if (geometry.first_light < 0) continue;
    const AreaLight& light = world.lights.areas[static_cast<std::size_t>(geometry.first_light)];
    Lamp lamp = ball_about(geometry);
    lamp.radius *= length(world_from_camera.inverse_direction({1, 0, 0}));
    lamp.centre = world_from_camera.inverse_point(lamp.centre);
    lamp.radiance = mean_of(world.lights.area_spectra[static_cast<std::size_t>(light.spectrum)]);
    const bool ahead = std::hypot(lamp.centre.x, lamp.centre.y) < most_slope * lamp.centre.z;
    if (ahead && lamp.radius > 0 && lamp.radiance > 0) lamps.push_back(lamp);
  }
  return lamps;
}

}  // namespace petzval::render
