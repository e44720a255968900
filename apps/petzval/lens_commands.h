// SPDX-License-Identifier: BSD-3-Clause
// The subcommands of `petzval lens`, each in its own file.
#pragma once

#include "command.h"

namespace petzval::app {

void add_lens_list(CLI::App& lens, Shared& shared);
void add_lens_info(CLI::App& lens, Shared& shared);
void add_lens_convert(CLI::App& lens, Shared& shared);
void add_lens_scale(CLI::App& lens, Shared& shared);
void add_lens_draw(CLI::App& lens, Shared& shared);
void add_lens_trace(CLI::App& lens, Shared& shared);
void add_lens_distortion(CLI::App& lens, Shared& shared);
void add_lens_illumination(CLI::App& lens, Shared& shared);
void add_lens_psf(CLI::App& lens, Shared& shared);
void add_lens_encircled_energy(CLI::App& lens, Shared& shared);
void add_lens_spots(CLI::App& lens, Shared& shared);
void add_lens_wavefront(CLI::App& lens, Shared& shared);
void add_lens_seidel(CLI::App& lens, Shared& shared);
void add_lens_mtf(CLI::App& lens, Shared& shared);
void add_lens_focus(CLI::App& lens, Shared& shared);
void add_lens_steps(CLI::App& lens, Shared& shared);
void add_lens_report(CLI::App& lens, Shared& shared);
void add_lens_fans(CLI::App& lens, Shared& shared);
void add_lens_zernike(CLI::App& lens, Shared& shared);
void add_lens_field_curvature(CLI::App& lens, Shared& shared);
void add_lens_colour(CLI::App& lens, Shared& shared);
void add_lens_vignetting(CLI::App& lens, Shared& shared);
void add_lens_chief_ray_angle(CLI::App& lens, Shared& shared);

}  // namespace petzval::app
