// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/lens/frame_pose.h>
#include <petzval/lens/lens.h>

#include <algorithm>
#include <cmath>

namespace petzval {

Frame frame_of(const Pose& pose) {
  Lens lens;
  lens.surfaces.resize(1);
  lens.surfaces[0].pose = pose;
  return frames_of(lens)[0];
}

Pose pose_of(const Frame& frame) {
  // Rows of a turn about x, y and z: the last column is (sin b, −sin a cos b, cos a cos b).
  const auto& r = frame.rows;
  Pose pose{frame.offset_mm[0], frame.offset_mm[1], frame.offset_mm[2], 0, 0, 0};
  const double cosine_b = std::hypot(r[1][2], r[2][2]);
  constexpr double upright = 1e-9;
  pose.tilt_y_deg = degrees(std::atan2(r[0][2], cosine_b));
  if (cosine_b > upright) {
    pose.tilt_x_deg = degrees(std::atan2(-r[1][2], r[2][2]));
    pose.tilt_z_deg = degrees(std::atan2(-r[0][1], r[0][0]));
  } else {
    pose.tilt_x_deg = degrees(std::atan2(r[2][1], r[1][1]));
  }
  return pose;
}

Frame composed(const Frame& outer, const Frame& inner) {
  Frame result;
  const Frame::Vector arm = outer.to_lens(inner.offset_mm);
  for (std::size_t i = 0; i < 3; ++i) {
    result.offset_mm[i] = outer.offset_mm[i] + arm[i];
    const Frame::Vector axis = outer.to_lens({inner.rows[0][i], inner.rows[1][i], inner.rows[2][i]});
    for (std::size_t k = 0; k < 3; ++k) result.rows[k][i] = axis[k];
  }
  return result;
}

Frame inverse(const Frame& frame) {
  Frame result;
  const Frame::Vector back = frame.from_lens(frame.offset_mm);
  for (std::size_t i = 0; i < 3; ++i) {
    result.offset_mm[i] = -back[i];
    for (std::size_t k = 0; k < 3; ++k) result.rows[i][k] = frame.rows[k][i];
  }
  return result;
}

bool is_as_good_as_none(const Frame& frame) {
  constexpr double rounding_mm = 1e-11, rounding = 1e-13;
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::abs(frame.offset_mm[i]) > rounding_mm) return false;
    for (std::size_t k = 0; k < 3; ++k)
      if (std::abs(frame.rows[i][k] - (i == k ? 1 : 0)) > rounding) return false;
  }
  return true;
}

}  // namespace petzval
