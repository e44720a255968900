// SPDX-License-Identifier: BSD-3-Clause
// PSF and MTF of a synthetic target's optics as a drawing.
#pragma once

#include <petzval/target/render_target.h>

#include <string>

#include "target_optics.h"

namespace petzval::app {

/// The PSF as a picture and in sections, and the modulation of optics and photosite, as SVG.
void write_target_plot(const std::string& path, const TargetOptics& optics, const Otf& otf,
                       const TargetOptions& options);

}  // namespace petzval::app
