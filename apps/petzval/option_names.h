// SPDX-License-Identifier: BSD-3-Clause
// The library's texts name parameters in backquotes; the program's name options.
#pragma once

#include <string>

namespace petzval::app {

/// The option of a library parameter: "scene.distance_m" is "--scene-distance".
std::string option_of(const std::string& parameter);

/// A text of the library with every `parameter` as its option.
std::string with_option_names(const std::string& text);

}  // namespace petzval::app
