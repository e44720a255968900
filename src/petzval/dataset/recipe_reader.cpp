// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/text_lines.h>
#include <petzval/base/whole_file.h>
#include <petzval/dataset/recipe.h>
#include <petzval/lens/formats/json_document.h>
#include <petzval/scene/wavelength_list.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

namespace petzval {

namespace {

namespace fs = std::filesystem;

constexpr const char* format_name = "petzval-dataset/1";
constexpr double most_items = 1e12;
/// Of the standard deviation: what of a normal distribution lies beyond is never drawn.
constexpr double normal_reach = 6;

double number_in(const JsonEntry& entry, double least, double most) {
  const double value = entry.number("a number");
  if (!(value >= least && value <= most))
    entry.fail(fmt::format("is {:g}; a number from {:g} to {:g} would be right", value, least, most));
  return value;
}

double whole_in(const JsonEntry& entry, double least, double most) {
  const double value = number_in(entry, least, most);
  if (value != std::floor(value)) entry.fail(fmt::format("is {:g}; a whole number would be right", value));
  return value;
}

/// The names of all files in a folder, in order; hidden ones are left out.
std::vector<std::string> files_in(const JsonEntry& entry, const std::string& base) {
  const std::string name = entry.text("the name of a folder");
  const fs::path folder = fs::path(base) / name;
  std::error_code failed;
  std::vector<std::string> files;
  for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed)) {
    const std::string file = at->path().filename().string();
    if (at->is_regular_file() && !file.starts_with('.')) files.push_back((fs::path(name) / file).string());
  }
  if (failed) entry.fail(fmt::format("cannot be read: {}", failed.message()));
  if (files.empty()) entry.fail("has no files");
  std::sort(files.begin(), files.end());
  return files;
}

class ParameterReader {
 public:
  ParameterReader(const RecipeParameter& parameter, const std::string& folder)
      : parameter_(parameter), folder_(folder) {}

  Distribution read(const JsonEntry& entry) const {
    if (!entry.is_object()) return Distribution::constant(value(entry));
    if (parameter_.is_name) entry.allow_only({"choose", "weights", "folder"});
    entry.allow_only(
        {"choose", "weights", "folder", "uniform", "log_uniform", "normal", "within", "integer"});
    for (const auto& [key, kind] : {std::pair{"uniform", Distribution::Kind::uniform},
                                    {"log_uniform", Distribution::Kind::log_uniform},
                                    {"integer", Distribution::Kind::integer},
                                    {"normal", Distribution::Kind::normal}})
      if (const auto found = entry.find(key)) {
        for (const auto& [other, unused] : entry.members("a distribution"))
          if (other != key && !(other == "within" && kind == Distribution::Kind::normal))
            entry.fail(fmt::format("has \"{}\" beside \"{}\"; one of them would be right", other, key));
        if (parameter_.is_whole && kind != Distribution::Kind::integer)
          entry.fail(fmt::format("has \"{}\" for a whole number; \"integer\" would be right", key));
        return kind == Distribution::Kind::normal ? normal(entry, *found) : spread(kind, *found);
      }
    return choice(entry);
  }

 private:
  ParameterValue value(const JsonEntry& entry) const {
    if (!parameter_.is_name) {
      const auto read = parameter_.is_whole ? whole_in : number_in;
      return read(entry, parameter_.least, parameter_.most);
    }
    const std::string name = entry.text("a name");
    if (name.empty()) entry.fail("is empty");
    return name;
  }

  Distribution choice(const JsonEntry& entry) const {
    Distribution result;
    if (const auto folder = entry.find("folder")) {
      if (!parameter_.is_name) folder->fail("holds files; this parameter is a number");
      entry.allow_only({"folder"});
      for (std::string& file : files_in(*folder, folder_)) result.values.push_back(std::move(file));
      return result;
    }
    for (const JsonEntry& item : entry.at("choose").items("a list of values"))
      result.values.push_back(value(item));
    if (result.values.empty()) entry.at("choose").fail("is empty");
    if (const auto weights = entry.find("weights")) {
      for (const JsonEntry& item : weights->items("a list of numbers"))
        result.weights.push_back(number_in(item, 1e-12, 1e12));
      if (result.weights.size() != result.values.size())
        weights->fail(
            fmt::format("has {} numbers for {} values", result.weights.size(), result.values.size()));
    }
    return result;
  }

  Distribution spread(Distribution::Kind kind, const JsonEntry& entry) const {
    const auto ends = two(entry);
    Distribution result{.kind = kind};
    const bool whole = kind == Distribution::Kind::integer;
    result.from = whole ? whole_in(ends[0], parameter_.least, parameter_.most)
                        : number_in(ends[0], parameter_.least, parameter_.most);
    result.to = whole ? whole_in(ends[1], parameter_.least, parameter_.most)
                      : number_in(ends[1], parameter_.least, parameter_.most);
    if (!(result.from <= result.to)) entry.fail("has its ends the wrong way round");
    if (kind == Distribution::Kind::log_uniform && !(result.from > 0))
      entry.fail("starts at or below 0, which has no logarithm");
    if (!std::isfinite(kind == Distribution::Kind::log_uniform ? result.to / result.from
                                                               : result.to - result.from))
      entry.fail("has its ends farther apart than a number can say; nearer ones would be right");
    return result;
  }

  Distribution normal(const JsonEntry& entry, const JsonEntry& moments) const {
    const auto two_numbers = two(moments);
    Distribution result{.kind = Distribution::Kind::normal};
    result.from = two_numbers[0].number("a mean");
    result.to = number_in(two_numbers[1], 0, 1e12);
    result.least = std::max(parameter_.least, result.from - normal_reach * result.to);
    result.most = std::min(parameter_.most, result.from + normal_reach * result.to);
    if (const auto within = entry.find("within")) {
      const auto ends = two(*within);
      result.least = std::max(result.least, number_in(ends[0], parameter_.least, parameter_.most));
      result.most = std::min(result.most, number_in(ends[1], parameter_.least, parameter_.most));
    }
    if (!(result.least <= result.most)) entry.fail("leaves no value within its limits");
    return result;
  }

  static std::vector<JsonEntry> two(const JsonEntry& entry) {
    auto items = entry.items("a list of two numbers");
    if (items.size() != 2) entry.fail(fmt::format("has {} numbers; two would be right", items.size()));
    return items;
  }

  const RecipeParameter& parameter_;
  const std::string& folder_;
};

void read_parameters(const JsonEntry& entry, Recipe& recipe) {
  const std::vector<RecipeParameter>& all = recipe_parameters();
  for (const auto& [name, value] : entry.members("the parameters by their names")) {
    const auto found = std::find_if(
        all.begin(), all.end(), [&, &key = name](const RecipeParameter& each) { return key == each.name; });
    const auto light = light_parameter(name);
    if (found == all.end() && !light) {
      std::string known;
      for (const RecipeParameter& each : all) known += std::string(each.name) + ", ";
      value.fail("is no parameter; there are " + known +
                 "and of single lights light_scale@0, light_turn_deg@0, light_kelvin@0");
    }
    const RecipeParameter& parameter = light ? light_parameters()[light->kind] : *found;
    recipe.parameters.emplace(name, ParameterReader(parameter, recipe.folder).read(value));
  }
}

void read_truth(const JsonEntry& entry, Recipe& recipe) {
  const std::vector<std::string>& names = truth_names();
  for (const JsonEntry& item : entry.items("a list of names")) {
    const std::string name = item.text("a name");
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      std::string known;
      for (const std::string& each : names) known += (known.empty() ? "" : ", ") + each;
      item.fail(fmt::format("is \"{}\"; {} would be right", name, known));
    }
    recipe.truth.insert(static_cast<Truth>(found - names.begin()));
  }
}

void read_psf_grid(const JsonEntry& entry, Recipe& recipe) {
  entry.allow_only({"rows", "columns", "size"});
  if (const auto rows = entry.find("rows")) recipe.psf_rows = static_cast<int>(whole_in(*rows, 1, 64));
  if (const auto columns = entry.find("columns"))
    recipe.psf_columns = static_cast<int>(whole_in(*columns, 1, 64));
  if (const auto size = entry.find("size")) recipe.psf_size = static_cast<int>(whole_in(*size, 1, 1023));
  if (recipe.psf_size % 2 == 0) entry.at("size").fail("is even; an odd number of pixels has a middle");
}

/// What does not go together.
void check(const JsonEntry& root, const Recipe& recipe) {
  const auto has = [&](const char* name) { return recipe.parameters.contains(name); };
  const JsonEntry entry = root.at("parameters");
  const auto both = [&](const char* a, const char* b) {
    if (has(a) && has(b)) entry.fail(fmt::format("has both {} and {}; one of them would be right", a, b));
  };
  if (!has("lens")) entry.fail("has no lens");
  if (!has("sensor")) entry.fail("has no sensor");
  if (!has("scene") && !has("world")) entry.fail("has neither a scene nor a world");
  both("scene", "world");
  both("f_number", "stop_down_ev");
  both("focus", "focus_distance_m");
  both("exposure_s", "exposure_compensation_ev");
  both("state", "state_number");
  if (has("grade") && !has("build"))
    entry.fail("has a grade without a build; \"build\": {\"integer\": [0, 999]} would be right");
  if (!recipe.build_tolerances.empty() && has("grade"))
    root.at("build_tolerances").fail("stands beside a grade; one of them would be right");
  if (!recipe.build_tolerances.empty() && !has("build"))
    root.at("build_tolerances")
        .fail("is without a build in the parameters; \"build\": {\"integer\": [0, 999]} would be right");
  for (const auto& [name, unused] : recipe.parameters)
    if (light_parameter(name) && !has("world"))
      entry.fail(fmt::format("has {}, which is of a world, and a flat scene", name));
  for (const char* name : {"scene_distance_m", "scene_angle_deg", "luminance_cd_m2", "illuminant"})
    if (has(name) && !has("scene"))
      entry.fail(fmt::format("has {}, which is of flat scenes, and a world", name));
  for (const char* name :
       {"camera_x", "camera_y", "camera_z", "look_x", "look_y", "look_z", "light_scale", "camera_move_x",
        "camera_move_y", "camera_move_z", "look_move_x", "look_move_y", "look_move_z", "rolling_shutter"})
    if (has(name) && !has("world"))
      entry.fail(fmt::format("has {}, which is of a world, and a flat scene", name));
  for (const std::string what : {"camera", "look", "camera_move", "look_move"}) {
    const bool x = recipe.parameters.contains(what + "_x"), y = recipe.parameters.contains(what + "_y"),
               z = recipe.parameters.contains(what + "_z");
    if (x != y || y != z)
      entry.fail(fmt::format("has some of {0}_x, {0}_y and {0}_z; all three would be right", what));
  }
  const auto needs = [&](Truth truth, const char* what) {
    if (recipe.has(truth))
      root.at("truth").fail(
          fmt::format("has {}, which {}", truth_names()[static_cast<std::size_t>(truth)], what));
  };
  if (recipe.denoise_light && !recipe.is_rendered())
    root.at("denoise_light").fail("is of a world, and the scene is flat; false would be right");
  if (!recipe.is_rendered()) {
    needs(Truth::normals, "needs a world");
    needs(Truth::albedo, "needs a world");
    needs(Truth::masks, "needs a world");
    needs(Truth::flow, "needs a world");
  } else {
    if (!has("camera_move_x") && !has("look_move_x")) {
      needs(Truth::flow, "needs a camera that moves: camera_move_x or look_move_x");
      if (has("rolling_shutter")) entry.fail("has rolling_shutter and a camera that stands still");
    }
  }
}

nlohmann::json value_json(const ParameterValue& value) {
  return std::visit([](const auto& each) { return nlohmann::json(each); }, value);
}

/// Folders are told by what was in them.
nlohmann::json expanded(nlohmann::json root, const Recipe& recipe) {
  for (const auto& [name, distribution] : recipe.parameters) {
    nlohmann::json& value = root["parameters"][name];
    if (!value.is_object() || !value.contains("folder")) continue;
    value = {{"choose", nlohmann::json::array()}};
    for (const ParameterValue& file : distribution.values) value["choose"].push_back(value_json(file));
  }
  return root;
}

}  // namespace

Recipe parse_recipe(const std::string& text, const std::string& file, const std::string& folder) {
  const JsonDocument document(text, file);
  const JsonEntry root(document);
  root.members("a recipe");
  const std::string format = root.at("format").text("a name");
  if (format != format_name)
    root.at("format").fail(fmt::format("is \"{}\"; \"{}\" would be right", quotable(format), format_name));
  root.allow_only({"format", "about", "items", "items_per_part", "seed", "parameters", "build_tolerances",
                   "sensor_set", "wavelengths_nm", "tolerance", "samples_per_pixel", "denoise_light", "bits",
                   "truth", "psf_grid"});
  if (const auto about = root.find("about")) about->text("a text that says what the items are");
  Recipe recipe;
  recipe.folder = folder;
  recipe.items = static_cast<std::size_t>(whole_in(root.at("items"), 1, most_items));
  if (const auto each = root.find("items_per_part"))
    recipe.items_per_part = static_cast<std::size_t>(whole_in(*each, 1, 1e6));
  if (const auto seed = root.find("seed"))
    recipe.seed = static_cast<std::uint64_t>(whole_in(*seed, 0, most_whole));
  read_parameters(root.at("parameters"), recipe);
  if (const auto tolerances = root.find("build_tolerances"))
    for (const JsonEntry& item : tolerances->items("a list of tolerances")) {
      try {
        for (const Tolerance& each :
             parse_tolerances(item.text("a tolerance such as \"element_tilt_deg@2-3=0.05\"")))
          recipe.build_tolerances.push_back(each);
      } catch (const InputError& error) {
        item.fail(error.what());
      }
    }
  if (const auto settings = root.find("sensor_set"))
    for (const JsonEntry& item : settings->items("a list of settings"))
      recipe.sensor_settings.push_back(item.text("a setting such as \"columns=640\""));
  if (const auto bands = root.find("wavelengths_nm")) {
    try {
      recipe.wavelengths_nm = parse_wavelengths_nm(bands->text("a text such as \"400:10:700\""));
    } catch (const InputError& error) {
      bands->fail(error.what());
    }
  }
  if (const auto tolerance = root.find("tolerance")) recipe.tolerance = number_in(*tolerance, 1e-6, 0.1);
  if (const auto samples = root.find("samples_per_pixel"))
    recipe.samples_per_pixel = static_cast<int>(whole_in(*samples, 1, 1 << 20));
  if (const auto denoise = root.find("denoise_light")) recipe.denoise_light = denoise->truth();
  if (const auto bits = root.find("bits")) {
    recipe.bits = static_cast<int>(whole_in(*bits, 8, 16));
    if (recipe.bits != 8 && recipe.bits != 16) bits->fail("is neither 8 nor 16");
  }
  if (const auto truth = root.find("truth")) read_truth(*truth, recipe);
  if (const auto grid = root.find("psf_grid")) read_psf_grid(*grid, recipe);
  check(root, recipe);
  recipe.text = expanded(document.root(), recipe).dump();
  return recipe;
}

Recipe read_recipe(const std::string& path) {
  constexpr std::size_t most_bytes = 64 << 20;
  return parse_recipe(read_whole_file(path, most_bytes), path, fs::path(path).parent_path().string());
}

}  // namespace petzval
