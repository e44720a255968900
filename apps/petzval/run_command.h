// SPDX-License-Identifier: BSD-3-Clause
// A command of this program within another: the points of a sweep, the steps of a handout.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace petzval::app {

struct CommandOutcome {
  int exit_code = 0;
  nlohmann::ordered_json numbers;  ///< what it printed with --json
  std::string error;               ///< what is wrong, if it failed
};

/// Runs the words of a command line, without "petzval" before them. \throws Cancelled.
CommandOutcome run_command(std::vector<std::string> arguments);

}  // namespace petzval::app
