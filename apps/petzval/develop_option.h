// SPDX-License-Identifier: BSD-3-Clause
// Options that say how a raw image is developed, for every command that makes pictures of raw images.
#pragma once

#include <petzval/simulate/develop.h>

#include <string>
#include <utility>
#include <vector>

#include "cli11.h"

namespace petzval::app {

struct DevelopChoice {
  std::string white_balance = "as-shot", demosaic = "auto", sensor, matrix = "auto", flat, space = "srgb",
              tone = "none", brightness = "0";
  bool keep_defects = false;
  DevelopOptions given;            ///< what the options fill in directly
  std::vector<std::string> steps;  ///< NAME=FILE

  /// \param after_light  of a command that makes the light, whose --sensor is another.
  void add_to(CLI::App& command, bool after_light = false);
  /// Reads the flat field and the sensor, if they are named. \throws InputError.
  Development development() const;
  /// Name and file of each step that is to be written. \throws InputError for a name that is none.
  std::vector<std::pair<std::string, std::string>> step_files() const;
};

}  // namespace petzval::app
