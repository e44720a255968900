// SPDX-License-Identifier: BSD-3-Clause
// Subcommands of `petzval optics` with files of their own.
#pragma once

#include "command.h"

namespace petzval::app {

/// What the name of a table that is written ends in.
inline std::vector<std::string> table_extensions() {
  return {".h5", ".hdf5"};
}

void add_optics_import(CLI::App& optics, Shared& shared);
void add_optics_export(CLI::App& optics, Shared& shared);

}  // namespace petzval::app
