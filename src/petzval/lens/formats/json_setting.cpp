// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/lens/formats/json_setting.h>

#include <algorithm>

namespace petzval {

namespace {

using nlohmann::json;

[[noreturn]] void bad_path(const std::string& path, const std::string& example) {
  throw InputError(fmt::format("\"{}\" is not a path; write it like {}", path, example));
}

std::vector<JsonStep> split_path(const std::string& path, const std::string& example) {
  std::vector<JsonStep> steps;
  std::size_t at = 0;
  while (at < path.size()) {
    if (path[at] == '[') {
      const std::size_t close = path.find(']', at);
      if (close == path.npos || steps.empty()) bad_path(path, example);
      const auto index = parse_integer(path.substr(at + 1, close - at - 1));
      if (!index || *index < 0) bad_path(path, example);
      steps.push_back({"", static_cast<std::size_t>(*index)});
      at = close + 1;
      continue;
    }
    if (!steps.empty() && path[at++] != '.') bad_path(path, example);
    const bool last_key = !steps.empty() && steps.back().key == "index_table";
    const std::size_t end = last_key ? path.size() : std::min(path.find_first_of(".[", at), path.size());
    if (end == at) bad_path(path, example);
    steps.push_back({path.substr(at, end - at), {}});
    at = end;
  }
  if (steps.empty()) bad_path(path, example);
  return steps;
}

json parse_value(const std::string& text) {
  json value = json::parse(text, nullptr, false);
  return value.is_discarded() ? json(text) : value;
}

}  // namespace

JsonSetting parse_json_setting(const std::string& assignment, const std::string& example) {
  const std::size_t equals = assignment.find('=');
  if (equals == assignment.npos) throw InputError(fmt::format("has no value; write it like {}=0.5", example));
  const std::string path = assignment.substr(0, equals);
  return {path, split_path(path, example), parse_value(assignment.substr(equals + 1))};
}

json& follow_json_step(json& at, const JsonStep& step, const std::string& path) {
  if (step.index) {
    if (!at.is_array()) throw InputError(fmt::format("{} is not a list and has no [{}]", path, *step.index));
    if (*step.index >= at.size())
      throw InputError(fmt::format("{}[{}] is not there; {} has {} entries, 0 to {}", path, *step.index, path,
                                   at.size(), at.size() - 1));
    return at[*step.index];
  }
  if (at.is_null()) at = json::object();
  if (!at.is_object()) throw InputError(fmt::format("{} has no entries, so no {}", path, step.key));
  return at[step.key];
}

}  // namespace petzval
