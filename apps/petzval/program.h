// SPDX-License-Identifier: BSD-3-Clause
// The whole command line of petzval.
#pragma once

#include "command.h"

namespace petzval::app {

/// Adds to a program named "petzval" the command, or the group of commands, that the first word names; if it
/// names none, or a sweep, which runs others, all of them.
void add_commands(CLI::App& program, Shared& shared, const std::vector<std::string>& words);

/// A mistake on the command line in one line: what is right, and which --help tells more.
std::string usage_message(CLI::App& program, const CLI::ParseError& error);

/// The words of `petzval help COMMAND…` as those of `petzval COMMAND… --help`; others as they are.
std::vector<std::string> with_help_option(std::vector<std::string> words);

}  // namespace petzval::app
