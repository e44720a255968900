// SPDX-License-Identifier: BSD-3-Clause
// What the program says of itself: help by groups, everyday options first; completion for shells; the man
// page. All are made from the commands and options as they are declared.
#pragma once

#include <string>
#include <vector>

#include "cli11.h"

namespace petzval::app {

/// Sorts the options of all commands into groups. In commands with many, only those of every day are shown,
/// unless the words of the command line ask for --help-all, which is then taken for --help.
void arrange_help(CLI::App& program, std::vector<std::string>& words);

/// A script for bash; zsh takes it after `autoload -U bashcompinit && bashcompinit`.
std::string bash_completion(const CLI::App& program);

/// The man page, in the language of man(7).
std::string man_page(const CLI::App& program);

/// petzval completion and petzval manual.
void add_help_commands(CLI::App& program);

}  // namespace petzval::app
