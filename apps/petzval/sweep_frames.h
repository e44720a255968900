// SPDX-License-Identifier: BSD-3-Clause
// The frames of a sweep that share their paths: rendered together before the first of them is written.
#pragma once

#include <petzval/simulate/render.h>

#include <cstddef>
#include <string>
#include <vector>

namespace petzval::app {

struct Shared;

/// Scenes are gathered from the command of each point, which then ends; rendered at once; and handed to the
/// same commands when they come again.
class SweepFrames {
 public:
  /// \param commands  of all points, in their order.
  explicit SweepFrames(std::vector<std::vector<std::string>> commands);

  /// Of what decides about their light: of all commands, and of the files that these name.
  const std::string& fingerprint() const { return fingerprint_; }
  /// Renders all frames, unless that is done. \throws InputError for those that cannot share; Cancelled.
  void render(const Shared& shared);
  /// Of the next command that asks.
  void show(std::size_t point) { point_ = point; }

  /// Called by the command of a point: whether its scene alone is wanted, and was taken.
  bool takes(const PreparedScene& scene);
  const Rendering& picture() const { return pictures_.at(point_); }

 private:
  std::vector<std::vector<std::string>> commands_;
  std::string fingerprint_;
  std::vector<PreparedScene> scenes_;
  std::vector<Rendering> pictures_;
  std::size_t point_ = 0;
};

}  // namespace petzval::app
