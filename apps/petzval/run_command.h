// SPDX-License-Identifier: BSD-3-Clause
// A command of this program within another: the points of a sweep, the steps of a handout.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "command.h"

namespace petzval::app {

struct CommandOutcome {
  int exit_code = 0;
  nlohmann::ordered_json numbers;  ///< what it printed with --json
  std::string error;               ///< what is wrong, if it failed
};

/// Runs the words of a command line, without "petzval" before them. \param renders  that keeps the world of
/// three-dimensional scenes from one command to the next; may be null. \param frames  that share their paths;
/// may be null. \throws Cancelled.
CommandOutcome run_command(std::vector<std::string> arguments, RenderSession* renders = nullptr,
                           SweepFrames* frames = nullptr);

}  // namespace petzval::app
