// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/stop.h>
#include <petzval/simulate/chief_rays.h>
#include <petzval/simulate/scene_truth.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval {

namespace {

using render::CameraRay;
using render::Vector3;

constexpr float unseen = std::numeric_limits<float>::quiet_NaN();

/// Calls work(row) for the rows of a picture.
template <typename Work>
void for_each_row(const Context& context, int rows, const Work& work) {
  run_within(context, [&](const ProgressCallback&) {
    parallel_for(static_cast<std::size_t>(rows), [&](std::size_t row) {
      check_stop();
      work(static_cast<int>(row));
    });
  });
}

/// Finds the place on the film that sees a point, by chord steps from a place nearby: the way from the chief
/// ray to the point, divided by what a pixel is worth there.
class PlaceFinder {
 public:
  explicit PlaceFinder(const ChiefRays& camera) : camera_(camera) {}

  /// Where a point is seen when the exposure ends of the row in which it then is; nothing beyond the field.
  std::optional<std::array<double, 2>> at_close(Vector3 point, std::array<double, 2> start) const {
    constexpr int most_steps = 40;
    constexpr double close_enough_px = 1e-5;
    std::array<double, 2> place = start;
    std::array<double, 4> ways{};  // along x and y for a pixel to the right, and for one down
    double area = 0;
    for (int step = 0; step < most_steps; ++step) {
      if (!std::isfinite(place[0]) || !std::isfinite(place[1])) return {};
      const render::CameraMotion& motion = *camera_.motion();
      const double time = motion.opens(place[1], camera_.film_rows()) + motion.exposure();
      const Vector3 seen = motion.world_from_camera(time).inverse_point(point);
      const auto rays = camera_.trace({place, {place[0] + 0.5, place[1]}, {place[0], place[1] + 0.5}});
      const auto at = [&](const CameraRay& ray) { return crossing(ray, seen.z); };
      const auto here = at(rays[0]);
      if (!here) return {};
      // Turns about the centre a little with each step; wide fields want it anew now and then.
      if (step % 4 == 0) {
        const auto right = at(rays[1]), below = at(rays[2]);
        if (!right || !below) return {};
        ways = {2 * ((*right)[0] - (*here)[0]), 2 * ((*right)[1] - (*here)[1]),
                2 * ((*below)[0] - (*here)[0]), 2 * ((*below)[1] - (*here)[1])};
        area = ways[0] * ways[3] - ways[1] * ways[2];
      }
      const double x = seen.x - (*here)[0], y = seen.y - (*here)[1];
      const double columns = (ways[3] * x - ways[2] * y) / area, rows = (ways[0] * y - ways[1] * x) / area;
      place[0] += columns, place[1] += rows;
      if (std::hypot(columns, rows) < close_enough_px) return place;
    }
    return {};
  }

 private:
  /// Where a ray crosses the plane at this distance along the axis.
  static std::optional<std::array<double, 2>> crossing(const CameraRay& ray, double z) {
    const double along = (z - ray.origin.z) / ray.direction.z;
    if (!ray.passes || !(along > 0)) return {};
    return std::array{ray.origin.x + along * ray.direction.x, ray.origin.y + along * ray.direction.y};
  }

  const ChiefRays& camera_;
};

}  // namespace

std::vector<float> rays_seen(const PreparedScene& scene, const Context& context) {
  const ChiefRays camera(scene);
  std::vector<float> rays(2 * camera.window().size(), unseen);
  for_each_row(context, camera.window().rows(), [&](int row) {
    const auto of_row = camera.trace_row(row);
    float* out = rays.data() + 2 * static_cast<std::size_t>(row) * of_row.size();
    for (std::size_t i = 0; i < of_row.size(); ++i) {
      const Vector3& along = of_row[i].direction;
      if (!of_row[i].passes || !(along.z > 0)) continue;
      out[2 * i] = static_cast<float>(along.x / along.z);
      out[2 * i + 1] = static_cast<float>(-along.y / along.z);
    }
  });
  return rays;
}

std::vector<float> flow_seen(const PreparedScene& scene, const Context& context) {
  const ChiefRays camera(scene);
  if (!camera.motion())
    throw InputError("optical flow is of a camera that moves; `camera_move` or `look_move` moves it");
  const PlaceFinder finder(camera);
  const render::PixelWindow& window = camera.window();
  std::vector<float> flow(2 * window.size(), unseen);
  for_each_row(context, window.rows(), [&](int row) {
    const auto rays = camera.trace_row(row);
    const double middle = window.top + row + 0.5;
    const render::Transform from = camera.world_from_camera(middle);
    std::array<double, 2> known{0, 0};  // of the pixel before, where the next one begins to look
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const auto point = camera.seen(rays[i], from);
      if (!point) continue;
      const std::array<double, 2> place{window.left + static_cast<double>(i) + 0.5, middle};
      const auto later = finder.at_close(point->at, {place[0] + known[0], place[1] + known[1]});
      if (!later) continue;
      known = {(*later)[0] - place[0], (*later)[1] - place[1]};
      const std::size_t at = 2 * (static_cast<std::size_t>(row) * rays.size() + i);
      flow[at] = static_cast<float>(known[0]), flow[at + 1] = static_cast<float>(known[1]);
    }
  });
  return flow;
}

Rendering render_sharp(const PreparedScene& scene, const Context& context) {
  PreparedScene sharp = scene;
  if (sharp.wants_autofocus()) autofocus(sharp, context);
  auto world = std::make_shared<PreparedWorld>(*sharp.world);
  // As it stands when exposure begins.
  if (world->camera.motion) world->camera.world_from_camera = world->camera.motion->world_from_camera(0);
  world->camera.motion.reset();
  world->camera.options.diffraction = false;
  world->camera.perspective.lens_radius = 0;
  sharp.world = std::move(world);
  sharp.request.checkpoint.clear(), sharp.request.region.reset(), sharp.request.sample_range.reset();
  sharp.request.camera_move.reset(), sharp.request.look_move.reset();
  if (sharp.lens) sharp.lens = camera_through_the_middle(sharp).lens;
  Rendering picture = render_scene(sharp, context);
  if (!scene.lens) return picture;
  for (int band = 0; band < picture.irradiance.bands(); ++band)
    for (float& value : picture.irradiance.band(band))
      value /= static_cast<float>(middle_share_of_stop * middle_share_of_stop);
  return picture;
}

std::array<std::array<double, 4>, 4> camera_pose(const PreparedScene& scene, double time) {
  const render::SceneCamera& camera = scene.world->camera;
  return (camera.motion ? camera.motion->world_from_camera(time) : camera.world_from_camera).matrix();
}

}  // namespace petzval
