// SPDX-License-Identifier: BSD-3-Clause
// Options that say how a clip is shot: its frames, what moves, what flickers, what an event camera sees.
#pragma once

#include <petzval/simulate/clip.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "cli11.h"

namespace petzval::app {

struct ClipChoice {
  ClipOptions given;
  double pan_deg_per_s = 0, pitch_deg_per_s = 0;
  std::array<double, 2> move_m_per_s{};  ///< to the right and up
  std::vector<double> event_thresholds;
  std::string path, vibration, shutter = "sensor", flicker = "none";
  std::optional<double> row_time_us;
  bool events = false;
  EventCameraOptions event_camera{.refractory_s = 1e-4};

  void add_to(CLI::App& command);
  /// \param sensor  whose shutter is used if nothing else is said. \throws InputError for words and numbers
  /// that contradict each other. \param seed  of the vibration.
  ClipOptions options(const Sensor& sensor, std::uint64_t seed) const;
  /// \throws InputError for options of an event camera without one.
  EventCameraOptions event_options(const CLI::App& command, const Sensor& sensor, std::uint64_t seed) const;

 private:
  Shutter chosen_shutter(const Sensor& sensor) const;
};

}  // namespace petzval::app
