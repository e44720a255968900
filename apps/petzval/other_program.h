// SPDX-License-Identifier: BSD-3-Clause
// Programs of others that do a last step, where they are installed.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace petzval::app {

/// Runs a program that is found on the PATH; what it prints on stdout goes nowhere. \returns its exit code,
/// nothing if it cannot be started.
std::optional<int> run_other_program(std::vector<std::string> words);

}  // namespace petzval::app
