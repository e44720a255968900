// SPDX-License-Identifier: BSD-3-Clause
// Subcommands of `petzval optics` with files of their own.
#pragma once

#include "command.h"

namespace petzval::app {

void add_optics_import(CLI::App& optics, Shared& shared);
void add_optics_export(CLI::App& optics, Shared& shared);

}  // namespace petzval::app
