// SPDX-License-Identifier: BSD-3-Clause
#include "command.h"

#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/lens/lens_file.h>

#include <cstdio>

namespace petzval::app {

CLI::App* add_command(CLI::App& parent, Shared& shared, const std::string& name, const std::string& description,
                      const std::string& example, bool prints_numbers, std::function<void()> work) {
  CLI::App* command = parent.add_subcommand(name, description);
  command->footer("Example:\n  " + example);
  command->add_option("--threads", shared.threads, "Threads to use; 0: all (results do not depend on it)")
      ->check(CLI::Range(0, 4096));
  command->add_option("--seed", shared.seed, "Seed of every random number");
  command->add_flag("--quiet", shared.quiet, "No notes and no progress bar");
  if (prints_numbers) command->add_flag("--json", shared.json, "Numbers as JSON on stdout");
  command->callback(std::move(work));
  return command;
}

void LensChoice::add_to(CLI::App& command, bool positional, bool required) {
  CLI::Option* option =
      command.add_option(positional ? "lens" : "--lens", path_or_name, "Lens file or name of a bundled lens");
  if (required) option->required();
  command.add_option("--set", settings, "Alter the lens: surfaces[4].thickness_mm=0.5 (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
  command.add_option("--substitute", substitutions, "Use another glass: LAK10C=CDGM:H-LAK10 (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
}

Lens LensChoice::read(const Shared& shared) const {
  LensReadOptions options;
  for (const std::string& text : substitutions) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
      throw InputError(fmt::format("--substitute {}: give it as OLD=NEW, for example LAK10C=CDGM:H-LAK10", text));
    options.substitutions[text.substr(0, equals)] = text.substr(equals + 1);
  }
  LensFile file = read_lens(path_or_name, options);
  for (const std::string& line : file.notes) note(shared, line);
  for (const std::string& setting : settings) file.lens = with_setting(file.lens, setting);
  return std::move(file.lens);
}

void note(const Shared& shared, const std::string& message) {
  if (!shared.quiet) fmt::print(stderr, "petzval: note: {}\n", message);
}

}  // namespace petzval::app
