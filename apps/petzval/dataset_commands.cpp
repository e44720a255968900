// SPDX-License-Identifier: BSD-3-Clause
// petzval dataset: many pictures with the truth beside them.
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/whole_file.h>
#include <petzval/dataset/dataset.h>

#include <memory>

#include "command.h"
#include "field_option.h"
#include "interrupted.h"
#include "output_option.h"

namespace petzval::app {

namespace {

constexpr double seconds_an_hour = 3600, bytes_a_gb = 1e9;

/// "3/16": the third of sixteen.
Shard parse_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  const auto whole = [](const std::string& word) {
    const auto number = parse_number(word);
    return number && *number >= 1 && *number <= 1e9 &&
                   *number == static_cast<double>(static_cast<long>(*number))
               ? static_cast<std::size_t>(*number)
               : 0;
  };
  const std::size_t index = slash == text.npos ? 0 : whole(text.substr(0, slash)),
                    count = slash == text.npos ? 0 : whole(text.substr(slash + 1));
  if (index == 0 || count == 0 || index > count)
    throw InputError(fmt::format("--shard {}: 1/16 to 16/16 would be right", text));
  return {index - 1, count};
}

std::string size_text(double bytes) {
  if (bytes >= bytes_a_gb) return fmt::format("{:.3g} GB", bytes / bytes_a_gb);
  return bytes >= 1e6 ? fmt::format("{:.3g} MB", bytes / 1e6) : fmt::format("{:.3g} kB", bytes / 1e3);
}

void write_starter(const std::string& path, const Shared& shared) {
  write_whole_file(path, starter_recipe());
  if (!shared.quiet)
    fmt::print("{}: a recipe to alter; petzval dataset make {} -o set makes it\n", path, path);
}

void print_parameters(const Shared& shared) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  const auto add = [&](const RecipeParameter& each, const std::string& name) {
    const char* is = each.is_name ? "name" : each.is_whole ? "whole" : "number";
    rows.push_back({{"parameter", name}, {"is", is}, {"meaning", each.meaning}});
    if (!shared.json) fmt::print("{:<26}{:<8}{}\n", name, is, each.meaning);
  };
  for (const RecipeParameter& each : recipe_parameters()) add(each, each.name);
  for (const RecipeParameter& each : light_parameters()) add(each, std::string(each.name) + "0");
  if (shared.json) print_json({{"rows", rows}});
}

struct MakeChoice {
  std::string recipe, folder, shard = "1/1";
};

void make(const MakeChoice& choice, const Shared& shared) {
  const Recipe recipe = read_recipe(choice.recipe);
  const Shard shard = parse_shard(choice.shard);
  DatasetReport made;
  try {
    made = make_dataset(recipe, choice.folder, shard, context_of(shared));
  } catch (const Cancelled&) {
    throw Interrupted("parts that are done are kept; the same command goes on with the rest");
  }
  if (shared.json)
    return print_json({{"parts", made.parts},
                       {"kept", made.kept},
                       {"elsewhere", made.elsewhere},
                       {"items", made.items},
                       {"failed", made.failed},
                       {"bytes", made.bytes}});
  if (shared.quiet) return;
  fmt::print("{} items in {} parts, {}", made.items, made.parts - made.kept - made.elsewhere,
             size_text(static_cast<double>(made.bytes)));
  if (made.kept) fmt::print("; {} parts were there", made.kept);
  if (made.elsewhere) fmt::print("; {} parts are in the making by another process", made.elsewhere);
  fmt::print("\n");
  if (made.failed)
    note(shared, fmt::format("{} of {} items could not be made: petzval dataset info {} says why",
                             made.failed, made.items, choice.folder));
}

void info(const std::string& folder, const Shared& shared) {
  const DatasetState state = dataset_state(folder);
  const Recipe& recipe = state.recipe;
  std::vector<std::string> truth;
  for (const Truth each : recipe.truth) truth.push_back(truth_names()[static_cast<std::size_t>(each)]);
  if (shared.json)
    return print_json({{"made_by", state.made_by},
                       {"items", recipe.items},
                       {"parts", recipe.parts()},
                       {"parts_done", state.parts_done},
                       {"items_done", state.items},
                       {"failed", state.failed},
                       {"bytes", state.bytes},
                       {"truth", truth},
                       {"errors", state.errors}});
  fmt::print("{} items in {} parts, by {}\n", recipe.items, recipe.parts(), state.made_by);
  fmt::print("  done     {} parts, {} items, {}\n", state.parts_done, state.items,
             size_text(static_cast<double>(state.bytes)));
  fmt::print("  truth    {}\n", truth.empty() ? "none" : fmt::format("{}", fmt::join(truth, ", ")));
  std::vector<std::string> drawn;
  for (const auto& [name, distribution] : recipe.parameters)
    if (!distribution.is_constant()) drawn.push_back(name);
  fmt::print("  varied   {}\n", drawn.empty() ? "noise alone" : fmt::format("{}", fmt::join(drawn, ", ")));
  for (const std::string& error : state.errors) fmt::print("  failed   {}\n", error);
}

void verify(const std::string& folder, const Shared& shared) {
  const std::vector<std::string> faults = verify_dataset(folder, context_of(shared));
  const DatasetState state = faults.empty() ? dataset_state(folder) : DatasetState();
  if (shared.json)
    print_json({{"faults", faults}});
  else if (faults.empty() && !shared.quiet)
    fmt::print("{} of {} parts are there and whole: {} items\n", state.parts_done, state.recipe.parts(),
               state.items);
  if (faults.empty()) return;
  for (std::size_t i = 1; i < faults.size(); ++i) note(shared, faults[i]);
  throw InputError(faults.front());
}

struct EstimateChoice {
  std::string recipe;
  std::size_t probes = 8;
};

void estimate(const EstimateChoice& choice, const Shared& shared) {
  const Recipe recipe = read_recipe(choice.recipe);
  const DatasetEstimate each = estimate_dataset(recipe, choice.probes, context_of(shared));
  const auto items = static_cast<double>(recipe.items);
  if (shared.json)
    return print_json({{"items", recipe.items},
                       {"probed", each.probed},
                       {"failed", each.failed},
                       {"cpu_s_an_item", each.cpu_s},
                       {"cpu_error_s", each.cpu_error_s},
                       {"cpu_hours", each.cpu_s * items / seconds_an_hour},
                       {"bytes", each.bytes * items},
                       {"threads", each.threads},
                       {"memory_bytes", each.memory_bytes}});
  fmt::print("{} items, by {} that were made and thrown away\n", recipe.items, each.probed);
  fmt::print("  time     {:.3g} CPU s an item ({:.2g} of standard error), {:.3g} CPU hours in all\n",
             each.cpu_s, each.cpu_error_s, each.cpu_s * items / seconds_an_hour);
  fmt::print("  bytes    {} an item, {} in all\n", size_text(each.bytes), size_text(each.bytes * items));
  fmt::print("  memory   {} a process of {} thread{}\n", size_text(each.memory_bytes), each.threads,
             each.threads == 1 ? "" : "s");
  if (each.failed) note(shared, fmt::format("{} of {} items could not be made", each.failed, each.probed));
}

CLI::App* add_to_group(CLI::App& group, Shared& shared, const char* name, const char* description,
                       const char* example, std::function<void()> work) {
  CLI::App* command = add_command(group, shared, name, description, example, true, std::move(work));
  command->remove_option(command->get_option("--seed"));  // the recipe has it
  return command;
}

}  // namespace

void add_dataset_commands(CLI::App& app, Shared& shared) {
  CLI::App* group = app.add_subcommand("dataset", "Make many pictures with the truth beside them");
  group->require_subcommand(1);

  auto path = std::make_shared<std::string>();
  CLI::App* command = add_to_group(*group, shared, "new", "Write a small recipe to start from",
                                   "petzval dataset new recipe.json", [path, &shared] {
                                     require_extension(*path, {".json"}, "a recipe");
                                     write_starter(*path, shared);
                                   });
  command->add_option("RECIPE", *path, "The file to write (.json)")->check(output_file())->required();
  add_to_group(*group, shared, "parameters", "List what a recipe may draw", "petzval dataset parameters",
               [&shared] { print_parameters(shared); });

  auto of_make = std::make_shared<MakeChoice>();
  command = add_to_group(*group, shared, "make", "Make a data set, or go on with one",
                         "petzval dataset make recipe.json -o set --shard 3/16",
                         [of_make, &shared] { make(*of_make, shared); });
  command->add_option("RECIPE", of_make->recipe, "What the items are drawn from (.json; docs/DATASETS.md)")
      ->required();
  command->add_option("-o,--output", of_make->folder, "The folder of the data set")->required();
  command
      ->add_option("--shard", of_make->shard,
                   "I/N: every Nth part, from the Ith on; without it, processes share the parts as they come")
      ->capture_default_str();

  auto folder = std::make_shared<std::string>();
  command = add_to_group(*group, shared, "info", "Say what a data set holds, and which items failed",
                         "petzval dataset info set", [folder, &shared] { info(*folder, shared); });
  command->add_option("FOLDER", *folder, "The folder of the data set")->required();
  command = add_to_group(*group, shared, "verify", "Read every byte of a data set and compare its sums",
                         "petzval dataset verify set", [folder, &shared] { verify(*folder, shared); });
  command->add_option("FOLDER", *folder, "The folder of the data set")->required();

  auto of_estimate = std::make_shared<EstimateChoice>();
  command = add_to_group(*group, shared, "estimate", "Say what a data set will take, from a few of its items",
                         "petzval dataset estimate recipe.json",
                         [of_estimate, &shared] { estimate(*of_estimate, shared); });
  command->add_option("RECIPE", of_estimate->recipe, "What the items are drawn from (.json)")->required();
  command->add_option("--probes", of_estimate->probes, "Items that are made for it")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
}

}  // namespace petzval::app
