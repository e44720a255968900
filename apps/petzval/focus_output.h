// SPDX-License-Identifier: BSD-3-Clause
// What focus, and render when it focuses, tell of it.
#pragma once

#include <petzval/simulate/autofocus.h>

#include <string>

#include "command.h"

namespace petzval::app {

/// A line an evaluation, and the film distance that was found, with what is sharp there.
std::string focus_text(const FocusRun& run, const std::string& measure);

/// The evaluations as a curve, into an SVG file.
void draw_focus(const FocusRun& run, const std::string& path);

}  // namespace petzval::app
