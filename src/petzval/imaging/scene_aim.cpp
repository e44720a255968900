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
      tangent_per_sample_(scene.tangent_per_sample()),
      shift_right_(0),
      shift_down_(0),
      cos_pan_(std::cos(radians(aim.pan_deg))),
      sin_pan_(std::sin(radians(aim.pan_deg))),
      cos_pitch_(std::cos(radians(aim.pitch_deg))),
      sin_pitch_(std::sin(radians(aim.pitch_deg))) {
  if (!scene.distance_m()) return;
  const double sample_m = *scene.distance_m() * tangent_per_sample_;
  shift_right_ = aim.right_m / sample_m;
  shift_down_ = -aim.up_m / sample_m;
}

AimedPlane::Place AimedPlane::at(double right, double down) const {
  if (!turned_) return {right - shift_right_, down - shift_down_, 1, 1};
  // The direction as the camera has it, x to the right, y up, 1 ahead; the camera was first tilted up, then
  // turned to the right.
  const double x = right * tangent_per_sample_, y = -down * tangent_per_sample_;
  const double up = y * cos_pitch_ + sin_pitch_, ahead = cos_pitch_ - y * sin_pitch_;
  const double aside = x * cos_pan_ + ahead * sin_pan_, front = ahead * cos_pan_ - x * sin_pan_;
  if (!(front > 0)) return {NAN, NAN, 0, 0};
  return {aside / front / tangent_per_sample_, -up / front / tangent_per_sample_,
          std::abs(cos_pan_ * front + aside * sin_pan_) / (front * front),
          std::abs(cos_pitch_ * front + up * sin_pitch_ * cos_pan_) / (front * front)};
}

void AimedPlane::turn(RowView& cells) const {
  if (straight_) return;
  for (std::size_t i = 0; i < cells.right.size(); ++i) {
    const Place place = at(cells.right[i], cells.down[i]);
    if (std::isnan(place.right)) {
      cells.g_source_sr[i] = 0;
      continue;
    }
    cells.right[i] = place.right;
    cells.down[i] = place.down;
    cells.width[i] *= static_cast<float>(place.widening);
    cells.height[i] *= static_cast<float>(place.heightening);
  }
}

}  // namespace petzval
