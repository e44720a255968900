// SPDX-License-Identifier: BSD-3-Clause
#include "command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/parallel.h>
#include <petzval/lens/lens_file.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>

namespace petzval::app {

CLI::App* add_command(CLI::App& parent, Shared& shared, const std::string& name,
                      const std::string& description, const std::string& example, bool prints_numbers,
                      std::function<void()> work) {
  CLI::App* command = parent.add_subcommand(name, description);
  command->footer("Example:\n  " + example);
  command->add_option("--threads", shared.threads, "Threads to use; 0: all (results do not depend on it)")
      ->check(CLI::Range(0, 4096));
  command->add_option("--seed", shared.seed, "Seed of every random number")->check(CLI::NonNegativeNumber);
  command->add_flag("--quiet", shared.quiet, "No notes and no progress bar");
  if (prints_numbers) command->add_flag("--json", shared.json, "Numbers as JSON on stdout");
  command->callback([&shared, work = std::move(work)] {
    const ThreadLimit threads(shared.threads);
    work();
  });
  return command;
}

void refuse_unknown_command(const CLI::App& program, int argc, const char* const* argv) {
  const CLI::App* at = &program;
  for (int i = 1; i < argc && argv[i][0] != '-'; ++i) {
    const std::vector<const CLI::App*> known = at->get_subcommands([](const CLI::App*) { return true; });
    if (known.empty()) return;
    std::vector<std::string> names;
    for (const CLI::App* command : known) names.push_back(command->get_name());
    const auto found = std::find(names.begin(), names.end(), argv[i]);
    if (found == names.end())
      throw InputError(fmt::format("{} has no command '{}'; the nearest are {} (see {} --help)",
                                   at->get_name(), argv[i], fmt::join(nearest_names(argv[i], names), ", "),
                                   at->get_name()));
    at = known[static_cast<std::size_t>(found - names.begin())];
  }
}

void LensChoice::add_to(CLI::App& command, bool positional, bool required) {
  CLI::Option* option =
      command.add_option(positional ? "lens" : "--lens", path_or_name, "Lens file or name of a bundled lens");
  if (required) option->required();
  add_settings_to(command);
}

void LensChoice::add_settings_to(CLI::App& command) {
  command.add_option("--set", settings, "Alter the lens: surfaces[4].thickness_mm=0.5 (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
  command
      .add_option("--substitute", substitutions,
                  "Use another glass: LAK10C=CDGM:H-LAK10, or by nd/Vd SK1=1.61025/56.71 (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
}

Lens LensChoice::read(const Shared& shared) const {
  LensReadOptions options;
  for (const std::string& text : substitutions) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
      throw InputError(fmt::format(
          "--substitute {}: give it as OLD=NEW, for example LAK10C=CDGM:H-LAK10 or, by nd and Vd, "
          "SK1=1.61025/56.71",
          text));
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

void require_extension(const std::string& path, const std::vector<std::string>& extensions,
                       const std::string& what) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (std::find(extensions.begin(), extensions.end(), extension) == extensions.end())
    throw InputError(path, fmt::format("{} is written as {}", what, fmt::join(extensions, ", ")));
}

}  // namespace petzval::app
