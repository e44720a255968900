// SPDX-License-Identifier: BSD-3-Clause
// Settings of a lens: assignments to its native JSON form.
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/formats/json_setting.h>
#include <petzval/lens/formats/native.h>
#include <petzval/lens/formats/native_setting.h>

#include <set>
#include <string_view>

namespace petzval {

namespace {

using nlohmann::json;

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
json& follow(json& root, const std::vector<JsonStep>& steps) {
  json* at = &root;
  std::string path, parent_key;
  for (const JsonStep& step : steps) {
    if (!step.index) clear_alternatives(*at, parent_key, step.key);
    at = &follow_json_step(*at, step, path);
    path = step.index ? item_path(path, *step.index) : member_path(path, step.key);
    if (!step.index) parent_key = step.key;
  }
  return *at;
}

/// Optional entries that null or, for glass, "air" takes away.
bool removes(const std::string& key, const json& value) {
  static const std::set<std::string> optional{
      "glass", "mirror", "semi_diameter_mm", "apertures", "conic", "asphere", "shape", "stop",
      "pose",  "melt",   "scatter",          "coating"};
  const bool air = key == "glass" && value.is_string() && (value == "air" || value == "AIR");
  return (value.is_null() && optional.count(key)) || air;
}

}  // namespace

json altered_native(json root, const std::vector<JsonStep>& steps, const json& value) {
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

namespace {

/// "surfaces[3].thickness_mm=paraxial" of the last surface, with the number that it stands for.
std::string with_numbers(const Lens& lens, const std::string& assignment) {
  constexpr std::string_view word = "=paraxial";
  if (!assignment.ends_with(word)) return assignment;
  const std::string place = assignment.substr(0, assignment.size() - word.size());
  const std::string last = fmt::format("surfaces[{}].thickness_mm", lens.surfaces.size() - 1);
  if (place != last)
    throw InputError("`set` " + assignment,
                     fmt::format("only {}, the distance to the sensor, can be paraxial", last));
  return fmt::format("{}={}", last, lens.last_sense() * first_order(lens).paraxial_image_mm);
}

}  // namespace

Lens with_setting(const Lens& lens, const std::string& assigned, const LensReadOptions& options) {
  const std::string assignment = with_numbers(lens, assigned);
  const std::string origin = "`set` " + assignment;
  JsonDocument document(lens_to_json(lens), lens.name);
  try {
    const JsonSetting setting =
        parse_json_setting(assignment, "surfaces[4].thickness_mm or aperture.f_number");
    document.replace(altered_native(document.root(), setting.steps, setting.value), setting.path, origin);
  } catch (const InputError& error) {
    throw InputError(origin, error.what());
  }
  LensReadOptions without_substitutions;
  without_substitutions.glasses = options.glasses;
  return read_native(document, without_substitutions);
}

}  // namespace petzval
