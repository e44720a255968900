// SPDX-License-Identifier: BSD-3-Clause
// The subcommands of `petzval optics`, each in its own file.
#pragma once

#include "command.h"

namespace petzval::app {

/// What the name of a table that is written ends in.
inline std::vector<std::string> table_extensions() {
  return {".h5", ".hdf5"};
}

void add_optics_build(CLI::App& optics, Shared& shared);
void add_optics_import(CLI::App& optics, Shared& shared);
void add_optics_export(CLI::App& optics, Shared& shared);
void add_optics_info(CLI::App& optics, Shared& shared);

}  // namespace petzval::app
