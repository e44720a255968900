// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/imaging/scene_aim.h>

#include <cmath>

namespace petzval {

void SceneAim::check(const Scene& scene) const {
  for (const double amount : {pan_deg, pitch_deg, right_m, up_m})
    if (!std::isfinite(amount)) throw InputError("the way of a camera or a scene must be of finite numbers");
  const bool turns = pan_deg != 0 || pitch_deg != 0, moves = right_m != 0 || up_m != 0;
  if (scene.is_panorama() && moves)
    throw InputError(
        "a panorama is at infinity and is not seen to move; a turn of the camera would be right");
  if (turns && scene.distance_m())
    throw InputError(
        "a camera turns before a scene at infinity; this one is at a finite distance, and a way of the scene "
        "(right, up) would be right");
  if (moves && !scene.distance_m())
    throw InputError(
        "a scene at infinity is not seen to move; a finite `scene.distance_m`, or a turn of the camera (pan, "
        "pitch), would be right");
  if (!scene.depth_m.empty() && !is_straight())
    throw InputError("a scene with depth does not move; `scene.depth` none makes a plane of it");
}

AimedPlane::AimedPlane(const SceneAim& aim, const Scene& scene)
    : straight_(aim.is_straight()),
      turned_(aim.pan_deg != 0 || aim.pitch_deg != 0),
      turn_{scene.tangent_per_sample(), std::cos(radians(aim.pan_deg)), std::sin(radians(aim.pan_deg)),
            std::cos(radians(aim.pitch_deg)), std::sin(radians(aim.pitch_deg))},
      shift_right_(0),
      shift_down_(0) {
  if (!scene.distance_m()) return;
  const double sample_m = *scene.distance_m() * turn_.tangent_per_sample;
  shift_right_ = aim.right_m / sample_m;
  shift_down_ = -aim.up_m / sample_m;
}

AimedPlane::Place AimedPlane::at(double right, double down) const {
  if (!turned_) return {right - shift_right_, down - shift_down_, 1, 1};
  const auto& [tangent_per_sample, cos_pan, sin_pan, cos_pitch, sin_pitch] = turn_;
  // The direction as the camera has it, x to the right, y up, 1 ahead.
  const double x = right * tangent_per_sample, y = -down * tangent_per_sample;
  const double up = y * cos_pitch + sin_pitch, ahead = cos_pitch - y * sin_pitch;
  const double aside = x * cos_pan + ahead * sin_pan, front = ahead * cos_pan - x * sin_pan;
  if (!(front > 0)) return {NAN, NAN, 0, 0};
  return {aside / front / tangent_per_sample, -up / front / tangent_per_sample,
          std::abs(cos_pan * front + aside * sin_pan) / (front * front),
          std::abs(cos_pitch * front + up * sin_pitch * cos_pan) / (front * front)};
}

void AimedPlane::turn(const RowView& straight, RowView& turned) const {
  if (straight_ || !turned_) {
    turned = straight;
    for (double& right : turned.right) right -= shift_right_;
    for (double& down : turned.down) down -= shift_down_;
    return;
  }
  const std::size_t count = straight.right.size();
  turned.right.resize(count);
  turned.down.resize(count);
  turned.width.resize(count);
  turned.height.resize(count);
  turned.g_source_sr.resize(count);
  turned.dark = straight.dark;
  for (std::size_t i = turn_row(turn_, straight, turned); i < count; ++i) {
    const Place place = at(straight.right[i], straight.down[i]);
    const bool seen = !std::isnan(place.right);
    turned.right[i] = seen ? place.right : straight.right[i];
    turned.down[i] = seen ? place.down : straight.down[i];
    turned.width[i] = straight.width[i] * (seen ? static_cast<float>(place.widening) : 1);
    turned.height[i] = straight.height[i] * (seen ? static_cast<float>(place.heightening) : 1);
    turned.g_source_sr[i] = seen ? straight.g_source_sr[i] : 0;
  }
}

}  // namespace petzval
