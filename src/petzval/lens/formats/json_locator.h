// SPDX-License-Identifier: BSD-3-Clause
// Builds a JSON value and notes the line of each entry on the way.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace petzval {

struct LocatedJson {
  nlohmann::json root;
  std::map<std::string, int> lines;                 ///< path → line
  std::map<std::string, std::string> long_numbers;  ///< path → text of numbers too long for a double
};

/// \throws InputError with file and line.
LocatedJson parse_located_json(std::string_view text, const std::string& file);

}  // namespace petzval
