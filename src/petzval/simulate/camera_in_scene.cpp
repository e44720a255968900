// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/simulate/camera_in_scene.h>
#include <petzval/simulate/frame_view.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

using render::Transform;
using render::Vector3;

Vector3 vector_of(const std::array<double, 3>& place) {
  return {place[0], place[1], place[2]};
}

struct Ball {
  Vector3 middle;
  double radius = 1;
};

Ball ball_of(const render::World& world) {
  const auto box = world.intersector->bounds();
  if (!box) return {};
  return {0.5 * ((*box)[0] + (*box)[1]), std::max(length((*box)[1] - (*box)[0]) / 2, 1e-6)};
}

/// Across the shorter side of the film [rad].
double narrow_view(const std::optional<Lens>& lens, const render::SceneCamera& camera) {
  constexpr double usual_deg = 40;
  if (!lens) return radians(camera.perspective.field_of_view_deg);
  Lens far = *lens;
  far.object_distance_mm.reset();
  const FrameView view = frame_view(far, camera.film);
  const double degrees = std::min(view.width, view.height);
  return radians(std::isfinite(degrees) && degrees > 0 && degrees < 180 ? degrees : usual_deg);
}

void set_field_of_view(double across_deg, render::SceneCamera& camera) {
  if (!(across_deg > 0 && across_deg < 180))
    throw InputError(fmt::format("`field_of_view_deg` {}: above 0 and below 180 would be right", across_deg));
  if (camera.lens)
    throw InputError(
        "`field_of_view_deg` is for cameras without a lens; a lens and its film have theirs: another lens, "
        "or `film_diagonal_mm`, would be right");
  // That of the camera is across the shorter side.
  const double share =
      std::min(1.0, static_cast<double>(camera.film.rows) / static_cast<double>(camera.film.columns));
  camera.perspective.field_of_view_deg = degrees(2 * std::atan(share * std::tan(radians(across_deg) / 2)));
}

}  // namespace

void place_camera(const RenderRequest& request, const std::optional<Lens>& lens, PreparedWorld& world,
                  const Context& context) {
  render::SceneCamera& camera = world.camera;
  if (request.field_of_view_deg) set_field_of_view(*request.field_of_view_deg, camera);
  const bool stands = world.description->has_camera || request.camera_at;
  const bool moves = request.camera_move || request.look_move;
  if (stands && !request.camera_at && !request.look_at && !moves) return;

  const Ball ball = ball_of(*world.world);
  const Transform was = camera.world_from_camera;
  Vector3 target = request.look_at ? vector_of(*request.look_at) : ball.middle;
  Vector3 eye = was.point({0, 0, 0});
  if (request.camera_at) eye = vector_of(*request.camera_at);
  if (stands && !request.camera_at && !request.look_at) {
    // It stands as the scene has it, and only moves; what is in the middle of its picture is as far as the
    // scene's middle, which matters where one of the two stays.
    const Vector3 ahead = normalised(was.direction({0, 0, 1}));
    target = eye + std::max(dot(ball.middle - eye, ahead), 1e-3 * ball.radius) * ahead;
  }
  if (!stands) {
    const double distance = ball.radius / std::sin(narrow_view(lens, camera) / 2);
    eye = target - distance * normalised(was.direction({0, 0, 1}));
    send_note(context,
              fmt::format("the scene has no camera; it stands {:.3g} scene units before the middle of "
                          "the scene, all of which is in the picture (`camera_at` puts it elsewhere)",
                          distance));
  }
  const Vector3 aim = target - eye;
  Vector3 up = normalised(was.direction({0, 1, 0}));
  if (length(cross(aim, up)) < 1e-6 * length(aim)) up = normalised(was.direction({0, 0, 1}));
  std::optional<Transform> looks;
  try {
    looks = Transform::look_at(eye, target, up).inverse();
    camera.world_from_camera = *looks;
  } catch (const InputError&) {
    throw InputError(
        !(length(aim) > 0)
            ? "`camera_at` and `look_at` are one place; two would be right"
            : "`camera_at` or `look_at` is too far away; places within 1e+07 scene units would be right");
  }
  // A scene that is seen in a mirror stays so.
  if (was.swaps_handedness() != camera.world_from_camera.swaps_handedness())
    camera.world_from_camera = camera.world_from_camera * Transform::scaling({-1, 1, 1});
  if (!moves) return;
  const auto by = [](const std::optional<std::array<double, 3>>& move) {
    return move ? vector_of(*move) : Vector3{0, 0, 0};
  };
  camera.motion = {.eye = eye,
                   .target = target,
                   .eye_move = by(request.camera_move),
                   .target_move = by(request.look_move),
                   .up = up,
                   .mirrored = was.swaps_handedness() != looks->swaps_handedness(),
                   .row_share = request.rolling_shutter};
  for (const double time : {0.25, 0.5, 0.75, 1.0}) try {
      camera.motion->world_from_camera(time);
    } catch (const InputError&) {
      throw InputError(
          "`camera_move` and `look_move` bring the camera to what it looks at, or too far away; "
          "less would be right");
    }
}

}  // namespace petzval
