// SPDX-License-Identifier: BSD-3-Clause
// A sensor on the command line, with entries of its file altered.
#pragma once

#include <petzval/sensor/sensor.h>

#include <string>
#include <vector>

#include "cli11.h"

namespace petzval::app {

/// Adds --sensor-set; read_sensor(sensor, settings) takes them.
inline void add_sensor_settings(CLI::App& command, std::vector<std::string>& settings) {
  command
      .add_option("--sensor-set", settings,
                  "Alter the sensor: pitch_um=3 or gain_modes[0].read_noise_e=1.5 (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
}

}  // namespace petzval::app
