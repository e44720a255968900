// SPDX-License-Identifier: BSD-3-Clause
// The subcommands of `petzval lens`, most in a file of their own.
#pragma once

#include "command.h"

namespace petzval::app {

void add_lens_list(CLI::App& lens, Shared& shared);
void add_lens_info(CLI::App& lens, Shared& shared);
void add_lens_convert(CLI::App& lens, Shared& shared);
void add_lens_scale(CLI::App& lens, Shared& shared);
void add_lens_draw(CLI::App& lens, Shared& shared);
void add_lens_trace(CLI::App& lens, Shared& shared);
/// All of analyses().
void add_lens_analyses(CLI::App& lens, Shared& shared);
void add_lens_psf(CLI::App& lens, Shared& shared);
void add_lens_seidel(CLI::App& lens, Shared& shared);
void add_lens_steps(CLI::App& lens, Shared& shared);
void add_lens_report(CLI::App& lens, Shared& shared);
void add_lens_for_sensor(CLI::App& lens, Shared& shared);
void add_lens_match(CLI::App& lens, Shared& shared);
void add_lens_new(CLI::App& lens, Shared& shared);
void add_lens_reverse(CLI::App& lens, Shared& shared);
void add_lens_transfer(CLI::App& lens, Shared& shared);
void add_lens_optimise(CLI::App& lens, Shared& shared);
void add_lens_fit_build(CLI::App& lens, Shared& shared);
void add_lens_tolerance(CLI::App& lens, Shared& shared);

}  // namespace petzval::app
