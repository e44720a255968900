// SPDX-License-Identifier: BSD-3-Clause
#include "optics_commands.h"

namespace petzval::app {

void add_optics_commands(CLI::App& app, Shared& shared) {
  CLI::App* optics = app.add_subcommand("optics", "Lens data tables: what a lens does to light, stored");
  optics->require_subcommand(1);
  add_optics_build(*optics, shared);
  add_optics_import(*optics, shared);
  add_optics_export(*optics, shared);
  add_optics_info(*optics, shared);
}

}  // namespace petzval::app
