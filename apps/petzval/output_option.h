// SPDX-License-Identifier: BSD-3-Clause
// Options that name what a command writes. Each such option is marked with one of the checks below; before a
// command works, whatever it is, what its marked options name is held against everything else that it names.
#pragma once

#include <string>
#include <vector>

#include "cli11.h"

namespace petzval::app {

// Marks of options: ->check(output_file()).
CLI::Validator output_file();            ///< a file
CLI::Validator output_entry();           ///< NAME=FILE
CLI::Validator output_folder();          ///< a folder, made with those above it where there is none
CLI::Validator output_file_or_folder();  ///< whether it can be written is for the command to check

/// A file that a command reads or writes, and the option that names it.
struct NamedFile {
  std::string option, path;
};

/// \throws InputError if an output is the same file as an input (through links or another way of writing its
/// path, too), or two outputs are the same: writing would destroy what is read or written.
void refuse_same_files(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs);

/// Checks the outputs of a parsed command: its other options' words may be inputs. \throws InputError as
/// refuse_same_files() and for a folder that does not exist; Failure for one that takes no files.
void check_outputs(const CLI::App& command);

/// Names of the options of a parsed command that are marked and were given.
std::vector<std::string> output_options(const CLI::App& command);

/// \throws InputError if `path`, or what of it exists, is no folder; Failure if it takes no files.
void require_folder(const std::string& path);

}  // namespace petzval::app
