// SPDX-License-Identifier: BSD-3-Clause
// Assignments to the native form of a lens.
#pragma once

#include <petzval/lens/formats/json_setting.h>

namespace petzval {

/// The lens's JSON with the entry at `steps` altered: a stop moves, alternatives replace each other, and null
/// takes away what is optional. \throws InputError if the steps lead nowhere.
nlohmann::json altered_native(nlohmann::json root, const std::vector<JsonStep>& steps,
                              const nlohmann::json& value);

}  // namespace petzval
