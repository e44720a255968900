// SPDX-License-Identifier: BSD-3-Clause
// Reads the parameters of a directive from the words of a file.
#pragma once

#include <petzval/render/pbrt/parameters.h>
#include <petzval/render/pbrt/tokens.h>

namespace petzval::render {

/// The whole of `text` as a number; nothing if it is none. Accepts "nan" and "inf": whoever uses it refuses
/// them.
std::optional<double> parse_scene_number(std::string_view text);

/// All "type name" value pairs from here on. \throws InputError with file, line and column.
Parameters read_parameters(Tokens& tokens, const Location& directive);

}  // namespace petzval::render
