// SPDX-License-Identifier: BSD-3-Clause
// The whole command line of petzval.
#pragma once

#include "command.h"

namespace petzval::app {

/// Adds every command to a program named "petzval".
void add_all_commands(CLI::App& program, Shared& shared);

/// A mistake on the command line in one line: what is right, and which --help tells more.
std::string usage_message(CLI::App& program, const CLI::ParseError& error);

/// The words of `petzval help COMMAND…` as those of `petzval COMMAND… --help`; others as they are.
std::vector<std::string> with_help_option(std::vector<std::string> words);

}  // namespace petzval::app
