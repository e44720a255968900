// SPDX-License-Identifier: BSD-3-Clause
#include "program.h"

#include "help.h"

#include <fmt/format.h>
#include <petzval/base/version.h>

#include <array>

namespace petzval::app {

namespace {

/// The command that the words have led to, and the words.
std::pair<CLI::App*, std::string> reached(CLI::App& program) {
  CLI::App* at = &program;
  std::string words = program.get_name();
  while (!at->get_subcommands().empty()) {
    at = at->get_subcommands().front();
    words += " " + at->get_name();
  }
  return {at, words};
}

}  // namespace

void add_commands(CLI::App& program, Shared& shared, const std::vector<std::string>& words) {
  struct Command {
    const char* name;
    void (*add)(CLI::App&, Shared&);
  };
  // In the order of the help.
  constexpr std::array<Command, 21> commands{
      {{"lens", add_lens_commands},     {"glass", add_glass_commands},    {"scene", add_scene_commands},
       {"optics", add_optics_commands}, {"image", add_image_command},     {"render", add_render_command},
       {"shoot", add_shoot_command},    {"focus", add_focus_command},     {"compare", add_compare_command},
       {"target", add_target_command},  {"sfr", add_sfr_command},         {"sensor", add_sensor_commands},
       {"sense", add_sense_command},    {"develop", add_develop_command}, {"measure", add_measure_command},
       {"sweep", add_sweep_command},    {"demo", add_demo_command},       {"handout", add_handout_command},
       {"merge", add_merge_command},    {"live", add_live_command},       {"dataset", add_dataset_commands}}};
  program.set_version_flag("--version", std::string("petzval ") + version());
  program.set_help_flag("-h,--help", "Prints this help");
  program.require_subcommand(1);
  // A sweep asks the commands that it runs for their options.
  if (!words.empty() && words.front() != "sweep")
    for (const Command& command : commands)
      if (words.front() == command.name) return command.add(program, shared);
  for (const Command& command : commands) command.add(program, shared);
  add_help_commands(program);
}

std::string usage_message(CLI::App& program, const CLI::ParseError& error) {
  const auto [command, words] = reached(program);
  std::string what = error.what();
  // CLI11 says "Could not convert: --nodes = 1.5"; the option knows what would be right.
  for (const CLI::Option* option : command->get_options({}))
    for (const std::string& word : option->results())
      if (what == fmt::format("Could not convert: {} = {}", option->get_name(), word))
        what = fmt::format("{} {}: {} would be right", option->get_name(), word, right_word(*option));
  return fmt::format("{} (see {} --help)", what, words);
}

std::vector<std::string> with_help_option(std::vector<std::string> words) {
  if (words.empty()) return {"--help"};
  if (words.front() != "help") return words;
  words.erase(words.begin());
  words.push_back("--help");
  return words;
}

}  // namespace petzval::app
