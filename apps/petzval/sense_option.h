// SPDX-License-Identifier: BSD-3-Clause
// Options that say how a sensor is exposed, for every command that makes raw images.
#pragma once

#include <petzval/simulate/expose.h>

#include <optional>
#include <string>
#include <vector>

#include "cli11.h"

namespace petzval::app {

struct SenseChoice {
  std::string exposure = "auto", metering = "highlights", illuminant, date_time;
  std::vector<std::string> without;
  ExposeOptions given;  ///< what the options fill in directly

  /// \param after_light  of a command that makes the light, which has an --f-number and an --illuminant of
  /// its own. \param of_clip  whose --frames are not averaged.
  void add_to(CLI::App& command, bool after_light = false, bool of_clip = false);
  /// \throws InputError for words that are wrong.
  ExposeOptions options() const;
};

}  // namespace petzval::app
