// SPDX-License-Identifier: BSD-3-Clause
// "surfaces[4].thickness_mm=0.5": a path into a JSON text, and a JSON value.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// A key of an object or an index of a list.
struct JsonStep {
  std::string key;
  std::optional<std::size_t> index;
};

/// The two sides of an assignment; a value that is no JSON is a text.
struct JsonSetting {
  std::string path;
  std::vector<JsonStep> steps;  ///< at least one
  nlohmann::json value;
};

/// Keys are parted by points; all that follows "index_table." is one key, for wavelengths have points of
/// their own. \param example  of a path, for messages. \throws InputError for what is no assignment.
JsonSetting parse_json_setting(const std::string& assignment, const std::string& example);

/// The entry that a step leads to. Keys that are absent are made, null becomes an object.
/// \param path  that led to `at`, for messages. \throws InputError where there is no such list or object.
nlohmann::json& follow_json_step(nlohmann::json& at, const JsonStep& step, const std::string& path);

}  // namespace petzval
