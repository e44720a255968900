// SPDX-License-Identifier: BSD-3-Clause
// "surfaces[4].thickness_mm=0.5": a path into the native JSON form, and a JSON value.
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/lens/formats/native.h>

#include <set>

namespace petzval {

namespace {

using nlohmann::json;

/// A key of an object or an index of a list.
struct Step {
  std::string key;
  std::optional<std::size_t> index;
};

[[noreturn]] void bad_path(const std::string& path) {
  throw InputError(
      fmt::format("\"{}\" is not a path; write it like surfaces[4].thickness_mm or aperture.f_number", path));
}

std::vector<Step> split_path(const std::string& path) {
  std::vector<Step> steps;
  std::size_t at = 0;
  while (at < path.size()) {
    if (path[at] == '[') {
      const std::size_t close = path.find(']', at);
      if (close == path.npos || steps.empty()) bad_path(path);
      const auto index = parse_integer(path.substr(at + 1, close - at - 1));
      if (!index || *index < 0) bad_path(path);
      steps.push_back({"", static_cast<std::size_t>(*index)});
      at = close + 1;
      continue;
    }
    if (!steps.empty() && path[at++] != '.') bad_path(path);
    // Wavelengths as keys have points of their own: all that follows "index_table." is one key.
    const bool last_key = !steps.empty() && steps.back().key == "index_table";
    const std::size_t end = last_key ? path.size() : std::min(path.find_first_of(".[", at), path.size());
    if (end == at) bad_path(path);
    steps.push_back({path.substr(at, end - at), {}});
    at = end;
  }
  if (steps.empty()) bad_path(path);
  return steps;
}

/// Objects that say one thing in several ways: naming another way replaces what was there.
void clear_alternatives(json& object, const std::string& parent_key, const std::string& key) {
  std::set<std::string> kept{key};
  if (parent_key == "glass" && (key == "nd" || key == "vd" || key == "dpgf")) kept = {"nd", "vd", "dpgf"};
  if (parent_key != "aperture" && parent_key != "glass") return;
  if (!object.is_object()) object = json::object();
  for (auto entry = object.begin(); entry != object.end();)
    entry = kept.count(entry.key()) ? std::next(entry) : object.erase(entry);
}

/// The entry that the steps lead to, made on the way where the format lets it be absent.
json& follow(json& root, const std::vector<Step>& steps) {
  json* at = &root;
  std::string path, parent_key;
  for (const Step& step : steps) {
    if (step.index) {
      if (!at->is_array())
        throw InputError(fmt::format("{} is not a list and has no [{}]", path, *step.index));
      if (*step.index >= at->size())
        throw InputError(fmt::format("{}[{}] is not there; {} has {} entries, 0 to {}", path, *step.index,
                                     path, at->size(), at->size() - 1));
      at = &(*at)[*step.index];
      path = item_path(path, *step.index);
      continue;
    }
    clear_alternatives(*at, parent_key, step.key);
    if (at->is_null()) *at = json::object();
    if (!at->is_object()) throw InputError(fmt::format("{} has no entries, so no {}", path, step.key));
    at = &(*at)[step.key];
    path = member_path(path, step.key);
    parent_key = step.key;
  }
  return *at;
}

json parse_value(const std::string& text) {
  json value = json::parse(text, nullptr, false);
  return value.is_discarded() ? json(text) : value;
}

/// Optional entries that null or, for glass, "air" takes away.
bool removes(const std::string& key, const json& value) {
  static const std::set<std::string> optional{"glass", "semi_diameter_mm", "conic", "asphere", "stop"};
  const bool air = key == "glass" && value.is_string() && (value == "air" || value == "AIR");
  return (value.is_null() && optional.count(key)) || air;
}

json altered(json root, const std::vector<Step>& steps, const json& value) {
  json& entry = follow(root, steps);
  if (steps.size() != 3 || steps[0].key != "surfaces" || !steps[1].index) {
    entry = value;
    return root;
  }
  json& surfaces = root["surfaces"];
  json& surface = surfaces[*steps[1].index];
  const std::string& key = steps[2].key;
  if (key == "stop" && value == true)
    for (json& other : surfaces) other.erase("stop");  // a lens has one stop: it moves here
  if (removes(key, value))
    surface.erase(key);
  else
    surface[key] = value;
  return root;
}

}  // namespace

Lens with_setting(const Lens& lens, const std::string& assignment, const LensReadOptions& options) {
  const std::string origin = "--set " + assignment;
  JsonDocument document(lens_to_json(lens), lens.name);
  const std::size_t equals = assignment.find('=');
  try {
    if (equals == assignment.npos)
      throw InputError("has no value; write it like surfaces[4].thickness_mm=0.5");
    const std::string path = assignment.substr(0, equals);
    const json value = parse_value(assignment.substr(equals + 1));
    document.replace(altered(document.root(), split_path(path), value), path, origin);
  } catch (const InputError& error) {
    throw InputError(origin, error.what());
  }
  LensReadOptions without_substitutions;
  without_substitutions.glasses = options.glasses;
  return read_native(document, without_substitutions);
}

}  // namespace petzval
