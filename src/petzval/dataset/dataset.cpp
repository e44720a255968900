// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/base/version.h>
#include <petzval/base/whole_file.h>
#include <petzval/dataset/dataset.h>
#include <petzval/dataset/part.h>
#include <petzval/dataset/tar_file.h>
#include <petzval/lens/lens_file.h>
#include <petzval/sensor/sensor.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <map>
#include <mutex>

namespace petzval {

namespace {

using nlohmann::json;
namespace fs = std::filesystem;

std::string this_program() {
  return std::string("petzval ") + version();
}

std::string head_path(const std::string& folder) {
  return folder + "/dataset.json";
}

std::string head_text(const std::string& made_by, const Recipe& recipe) {
  return json{{"made_by", made_by},
              {"recipe", json::parse(recipe.text)},
              {"recipe_crc32", crc32_text(recipe.text)}}
             .dump(1) +
         "\n";
}

/// What is wrong with a recipe's lens or sensor is wrong with all items: told at once.
void check_names(const Recipe& recipe) {
  const auto there = [&](const std::string& name) {
    const std::string file = (fs::path(recipe.folder) / name).string();
    std::error_code failed;
    return fs::is_regular_file(file, failed) ? file : name;
  };
  for (const ParameterValue& name : recipe.parameters.at("lens").values) {
    const Lens lens = read_lens(there(std::get<std::string>(name))).lens;
    for (const Tolerance& tolerance : recipe.build_tolerances) check(lens, tolerance);
  }
  for (const ParameterValue& name : recipe.parameters.at("sensor").values)
    read_sensor(there(std::get<std::string>(name)), recipe.sensor_settings).require_electronics();
}

/// The folder, with the recipe in it, or with the same recipe in it already.
void open_folder(const Recipe& recipe, const std::string& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) throw InputError(folder, "cannot be made: " + failed.message());
  const std::string path = head_path(folder);
  if (!fs::exists(path)) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
      // Unless another process has begun in the meantime.
      if (entry.path().filename().string().starts_with("part-") && !fs::exists(path))
        throw InputError(
            folder, "holds parts of a data set without its dataset.json; an empty folder would be right");
    if (!fs::exists(path)) return write_whole_file(path, head_text(this_program(), recipe));
  }
  const DatasetState state = dataset_state(folder);
  if (state.made_by != this_program())
    throw InputError(path,
                     fmt::format("is of {}, this is {}; the same version or a new folder would be right",
                                 state.made_by, this_program()));
  if (state.recipe.text != recipe.text)
    throw InputError(path, "is of another recipe; the same recipe or a new folder would be right");
}

double process_cpu_s() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

}  // namespace

DatasetReport make_dataset(const Recipe& recipe, const std::string& folder, const Shard& shard,
                           const Context& context) {
  if (shard.count == 0 || shard.index >= shard.count)
    throw InputError(fmt::format("`shard` {} of {}: 1 to {} would be right", shard.index + 1, shard.count,
                                 std::max<std::size_t>(1, shard.count)));
  check_names(recipe);
  open_folder(recipe, folder);
  std::vector<DatasetPart> open;
  std::size_t waiting = 0;
  DatasetReport report;
  for (std::size_t number = shard.index; number < recipe.parts(); number += shard.count) {
    ++report.parts;
    const DatasetPart part(folder, number);
    if (part.is_done()) {
      ++report.kept;
      continue;
    }
    const auto [first, last] = recipe.items_of(number);
    open.push_back(part), waiting += last - first;
  }
  ItemMaker maker(recipe);
  run_within(context, [&](const ProgressCallback& progress) {
    std::size_t made = 0;
    for (const DatasetPart& part : open) {
      const auto sums = part.make(recipe, maker, [&] {
        if (progress) progress(static_cast<double>(++made) / static_cast<double>(waiting), "items");
      });
      if (!sums) {
        ++report.elsewhere;
        continue;
      }
      report.items += sums->items, report.failed += sums->failed, report.bytes += sums->archive_bytes;
    }
  });
  return report;
}

DatasetState dataset_state(const std::string& folder) {
  const std::string path = head_path(folder), text = read_whole_file(path);
  DatasetState state;
  try {
    const json root = json::parse(text);
    state.made_by = root.at("made_by");
    state.recipe = parse_recipe(root.at("recipe").dump(), path, folder);
  } catch (const json::exception&) {
    throw InputError(path, "is damaged");
  }
  if (head_text(state.made_by, state.recipe) != text) throw InputError(path, "is damaged");
  std::map<std::string, std::size_t> reasons;
  for (std::size_t number = 0; number < state.recipe.parts(); ++number) {
    const DatasetPart part(folder, number);
    if (!part.is_done()) continue;
    const PartSums sums = part.sums();
    ++state.parts_done;
    state.items += sums.items, state.failed += sums.failed, state.bytes += sums.archive_bytes;
    if (sums.failed == 0) continue;
    for (const json& line : part.lines())
      if (line.contains("error")) ++reasons[line["error"].get<std::string>()];
  }
  std::vector<std::pair<std::size_t, std::string>> ordered;
  for (const auto& [reason, count] : reasons) ordered.emplace_back(count, reason);
  std::stable_sort(ordered.begin(), ordered.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  for (const auto& [count, reason] : ordered)
    state.errors.push_back(fmt::format("{} item{}: {}", count, count == 1 ? "" : "s", reason));
  return state;
}

std::vector<std::string> verify_dataset(const std::string& folder, const Context& context) {
  const DatasetState state = dataset_state(folder);
  const std::size_t parts = state.recipe.parts();
  std::vector<std::vector<std::string>> of_part(parts);
  std::mutex mutex;
  std::size_t done = 0;
  run_within(context, [&](const ProgressCallback& progress) {
    parallel_tasks(parts, [&](std::size_t number) {
      const DatasetPart part(folder, number);
      if (part.is_done()) of_part[number] = part.faults(state.recipe);
      const std::lock_guard lock(mutex);
      if (progress) progress(static_cast<double>(++done) / static_cast<double>(parts), "parts");
    });
  });
  std::vector<std::string> all;
  for (std::vector<std::string>& each : of_part) std::move(each.begin(), each.end(), std::back_inserter(all));
  return all;
}

DatasetEstimate estimate_dataset(const Recipe& recipe, std::size_t probes, const Context& context) {
  check_names(recipe);
  ItemMaker maker(recipe);
  DatasetEstimate estimate;
  std::string reason;
  std::mutex mutex;
  const auto probe = [&](std::size_t number) {
    double bytes = 0;
    std::string problem;
    try {
      for (const ItemFile& file : maker.make(number).files) bytes += static_cast<double>(file.bytes.size());
    } catch (const InputError& error) {
      problem = error.what();
    }
    const std::lock_guard lock(mutex);
    ++estimate.probed, estimate.bytes += bytes;
    if (!problem.empty()) ++estimate.failed, reason = problem;
  };
  double sum = 0, squares = 0, rounds = 0;
  run_within(context, [&](const ProgressCallback& progress) {
    const std::size_t at_once = items_at_once(recipe.items);
    probes = std::min(std::max(probes, 2 * at_once), recipe.items);
    for (std::size_t first = 0; first < probes; first += at_once, ++rounds) {
      const std::size_t count = std::min(at_once, probes - first);
      const double before = process_cpu_s();
      parallel_tasks(count,
                     [&](std::size_t i) { probe((2 * (first + i) + 1) * recipe.items / (2 * probes)); });
      const double took = (process_cpu_s() - before) / static_cast<double>(count);
      sum += took, squares += took * took;
      if (progress) progress(static_cast<double>(first + count) / static_cast<double>(probes), "items");
    }
    estimate.threads = thread_count();
  });
  if (estimate.failed == estimate.probed)
    throw InputError(fmt::format("none of {} items could be made: {}", estimate.probed, reason));
  estimate.cpu_s = sum / rounds;
  estimate.cpu_error_s =
      rounds > 1 ? std::sqrt(std::max(0.0, squares / rounds - estimate.cpu_s * estimate.cpu_s) / (rounds - 1))
                 : 0;
  estimate.bytes /= static_cast<double>(estimate.probed);
  estimate.memory_bytes = peak_memory_bytes();
  return estimate;
}

}  // namespace petzval
