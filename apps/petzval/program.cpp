// SPDX-License-Identifier: BSD-3-Clause
#include "program.h"

#include "help.h"

#include <fmt/format.h>
#include <petzval/base/version.h>

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

void add_all_commands(CLI::App& program, Shared& shared) {
  program.set_version_flag("--version", std::string("petzval ") + version());
  program.set_help_flag("-h,--help", "Prints this help");
  program.require_subcommand(1);
  add_lens_commands(program, shared);
  add_glass_commands(program, shared);
  add_scene_commands(program, shared);
  add_optics_commands(program, shared);
  add_image_command(program, shared);
  add_render_command(program, shared);
  add_shoot_command(program, shared);
  add_focus_command(program, shared);
  add_compare_command(program, shared);
  add_target_command(program, shared);
  add_sfr_command(program, shared);
  add_sensor_commands(program, shared);
  add_sense_command(program, shared);
  add_develop_command(program, shared);
  add_measure_command(program, shared);
  add_sweep_command(program, shared);
  add_demo_command(program, shared);
  add_handout_command(program, shared);
  add_merge_command(program, shared);
  add_live_command(program, shared);
  add_dataset_commands(program, shared);
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
