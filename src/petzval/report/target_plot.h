// SPDX-License-Identifier: BSD-3-Clause
// PSF and MTF of a synthetic target's optics as a drawing.
#pragma once

#include <petzval/target/render_target.h>

#include <string>

namespace petzval {

/// SVG: the PSF as a picture and in sections, and the modulation of optics and photosite.
std::string target_plot_svg(const Otf& otf, const TargetOptions& options, const std::string& title);

}  // namespace petzval
