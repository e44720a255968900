// SPDX-License-Identifier: BSD-3-Clause
// What scenes there are by name.
#pragma once

#include <nlohmann/json.hpp>

namespace petzval::app {

/// The bundled three-dimensional scenes: name, kind and description of each.
nlohmann::ordered_json rows_of_worlds();

/// Prints rows of that kind, or as JSON.
void print_scenes(const nlohmann::ordered_json& rows, bool json);

}  // namespace petzval::app
