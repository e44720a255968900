// SPDX-License-Identifier: BSD-3-Clause
#include "sweep_result.h"

#include <fmt/format.h>
#include <petzval/base/context.h>
#include <petzval/base/staged_files.h>
#include <petzval/base/version.h>
#include <petzval/base/whole_file.h>
#include <petzval/render/pbrt/scene_files.h>

#include <algorithm>
#include <filesystem>

#include "field_option.h"
#include "run_command.h"
#include "sweep_frames.h"
#include "sweep_yield.h"

namespace petzval::app {

namespace {

using Json = nlohmann::ordered_json;

std::string base_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

/// Checksums of what the point wrote, by name; null for a file that is not there.
Json checksums_of_outputs(const std::vector<std::string>& paths) {
  Json sums = Json::object();
  for (const std::string& path : paths) {
    std::error_code ignored;
    sums[base_name(path)] = std::filesystem::is_regular_file(path, ignored)
                                ? Json(render::hash_text(read_whole_file(path)))
                                : Json();
  }
  return sums;
}

Json record_of(const PointResult& result) {
  return {{"version", version()},
          {"arguments", result.arguments},
          {"files", result.checksums},
          {"written", checksums_of_outputs(result.outputs)},
          {"numbers", result.numbers}};
}

/// An entry of a record, which may be damaged.
Json entry_of(const Json& record, const char* key) {
  return record.is_object() && record.contains(key) ? record[key] : Json();
}

/// Takes the point from an earlier run of the same arguments, if it was finished then and stands as it did.
/// \param corners  whether they are to be measured.
bool recall(const std::string& record_path, bool corners, PointResult& result, const Shared& shared) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(record_path, ignored)) return false;
  const Json record = Json::parse(read_whole_file(record_path), nullptr, false);
  if (entry_of(record, "version") != Json(version()) ||
      entry_of(record, "arguments") != Json(result.arguments) ||
      entry_of(record, "files") != result.checksums)
    return false;
  const Json written = checksums_of_outputs(result.outputs), numbers = entry_of(record, "numbers");
  for (const auto& [name, sum] : written.items())
    if (entry_of(entry_of(record, "written"), name.c_str()) != sum) {
      note(shared, fmt::format("{} is {}; the point is made again", name,
                               sum.is_null() ? "gone" : "not as it was written"));
      return false;
    }
  if (!numbers.is_object() || numbers.contains("corners") != corners) return false;
  result.numbers = numbers;
  return result.done = true;
}

/// Runs the command of the point, and records what it made.
void make(PointResult& result, const SweepCommand& options, const std::string& name, const Shared& shared) {
  const CommandOutcome outcome = run_command(result.arguments, shared.renders, shared.frames);
  result.exit_code = outcome.exit_code;
  result.numbers = outcome.numbers;
  result.done = outcome.exit_code == 0 && result.numbers.is_object();
  if (result.done && options.corners) measure_corners(result, shared);
  if (result.done)
    return write_whole_file(options.folder + "/" + name + ".json", record_of(result).dump(1) + "\n");
  result.numbers = Json::object();
  result.picture.clear();
  result.outputs.clear();
  result.error =
      outcome.exit_code == 0 ? "the command gave no numbers" : in_words_of_sweep(outcome.error, result.point);
}

}  // namespace

std::string name_of_point(std::size_t index) {
  return fmt::format("point-{:04}", index);
}

Json checksums_of_files(const std::vector<std::string>& arguments, const std::string& outputs) {
  Json sums = Json::object();
  for (const std::string& argument : arguments)
    for (const std::string& name : {argument, argument.substr(argument.find('=') + 1)}) {
      std::error_code ignored;
      if (!name.starts_with(outputs) && std::filesystem::is_regular_file(name, ignored))
        sums[name] = render::hash_text(read_whole_file(name));
    }
  return sums;
}

std::vector<std::string> words_of_point(const CLI::App& app, const SweepCommand& options,
                                        const SweepPoint& point, const std::string& scene_angle,
                                        const Shared& shared) {
  std::vector<std::string> words = arguments_of(app, options, point, shared);
  if (!scene_angle.empty()) words.insert(words.end(), {"--scene-angle-least", scene_angle});
  return words;
}

PointResult run_point(const CLI::App& app, const SweepCommand& options, const SweepPoint& point,
                      std::size_t index, const std::string& scene_angle, const Shared& shared) {
  PointResult result;
  result.point = point;
  result.arguments = words_of_point(app, options, point, scene_angle, shared);
  const std::string name = name_of_point(index), stem = options.folder + "/" + name;
  if (options.makes_pictures()) {
    result.outputs = {result.picture = stem + ".png"};
    for (const std::string& extension : options.other_files())
      result.outputs.push_back(stem + "." + extension);
  }
  for (const std::string& path : result.outputs)
    result.arguments.insert(result.arguments.end(), {"-o", path});
  result.checksums = checksums_of_files(result.arguments, stem);
  if (shared.frames) result.checksums["frames that share paths"] = shared.frames->fingerprint();
  if (recall(stem + ".json", options.corners, result, shared)) return result;
  if (shared.frames) {
    shared.frames->render(shared);
    shared.frames->show(index);
  }
  make(result, options, name, shared);
  return result;
}

}  // namespace petzval::app
