// SPDX-License-Identifier: BSD-3-Clause
// How a camera and its scene move while a clip is shot.
#pragma once

#include <petzval/imaging/scene_aim.h>

#include <string>
#include <vector>

namespace petzval {

/// Turns of the camera and ways of the scene at instants, in straight lines from one to the next, held before
/// the first and after the last.
class MotionPath {
 public:
  struct Key {
    double t_s = 0;
    SceneAim aim = {};
  };

  /// At rest.
  MotionPath() = default;
  /// \throws InputError unless times increase and all numbers are finite.
  explicit MotionPath(std::vector<Key> keys);
  /// From rest at t = 0 on, at these speeds [degrees and metres per second], for so long.
  static MotionPath steady(const SceneAim& per_second, double duration_s);
  /// A .csv whose first line names its columns: t_s, and any of pan_deg, pitch_deg, right_m and up_m.
  /// \throws InputError with file and line.
  static MotionPath read(const std::string& path);

  bool is_rest() const;
  SceneAim at(double t_s) const;
  const std::vector<Key>& keys() const { return keys_; }

 private:
  std::vector<Key> keys_;
};

}  // namespace petzval
