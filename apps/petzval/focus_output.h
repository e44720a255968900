// SPDX-License-Identifier: BSD-3-Clause
// What focus, and render when it focuses, tell of it.
#pragma once

#include <petzval/focus/autofocus.h>

#include <string>

#include "command.h"

namespace petzval::app {

/// A line an evaluation, and the film distance that was found.
std::string focus_text(const FocusResult& result, const std::string& measure);

/// The evaluations as a curve, into an SVG file.
void draw_focus(const FocusResult& result, const std::string& title, const std::string& path);

/// A note where the sharpest place lies at an end of the range.
void note_focus_at_the_end(const FocusResult& result, const Shared& shared);

}  // namespace petzval::app
