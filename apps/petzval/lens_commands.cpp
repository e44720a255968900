// SPDX-License-Identifier: BSD-3-Clause
#include "lens_commands.h"

namespace petzval::app {

void add_lens_commands(CLI::App& app, Shared& shared) {
  CLI::App* lens = app.add_subcommand("lens", "Look at a lens: data, drawings, rays, what it does to light");
  lens->require_subcommand(1);
  add_lens_list(*lens, shared);
  add_lens_info(*lens, shared);
  add_lens_draw(*lens, shared);
  add_lens_trace(*lens, shared);
  add_lens_steps(*lens, shared);
  add_lens_analyses(*lens, shared);
  add_lens_psf(*lens, shared);
  add_lens_seidel(*lens, shared);
  add_lens_report(*lens, shared);
  add_lens_for_sensor(*lens, shared);
  add_lens_match(*lens, shared);
  add_lens_new(*lens, shared);
  add_lens_reverse(*lens, shared);
  add_lens_transfer(*lens, shared);
  add_lens_optimise(*lens, shared);
  add_lens_fit_build(*lens, shared);
  add_lens_tolerance(*lens, shared);
  add_lens_convert(*lens, shared);
  add_lens_scale(*lens, shared);
}

}  // namespace petzval::app
