// SPDX-License-Identifier: BSD-3-Clause
#include "sweep_arguments.h"

#include <fmt/format.h>
#include <petzval/base/error.h>

#include <algorithm>

#include "output_option.h"
#include "program.h"

namespace petzval::app {

namespace {

/// What the names of a sensor's entries begin with.
constexpr std::string_view sensor_prefix = "sensor.";

/// Words of a point's command line that name it: where they stand.
bool is_positional(const SweepCommand& options, const std::string& key) {
  return options.command == "lens" ? key == "lens" : key == "scene";
}

bool is_sensor_entry(const CLI::App& app, const std::string& key) {
  return key.starts_with(sensor_prefix) && app.get_option_no_throw("--sensor-set") != nullptr;
}

/// "--key" given among the words.
bool is_given(const std::vector<std::string>& words, const std::string& key) {
  const std::string option = "--" + key;
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
    return word == option || word.starts_with(option + "=");
  });
}

/// "KEY=…" given behind --set or --sensor-set.
bool is_set(const std::vector<std::string>& words, const std::string& option, const std::string& entry) {
  for (std::size_t i = 0; i < words.size(); ++i)
    if ((words[i] == option && i + 1 < words.size() && words[i + 1].starts_with(entry + "=")) ||
        words[i].starts_with(option + "=" + entry + "="))
      return true;
  return false;
}

[[noreturn]] void refuse_fixed(const std::string& key) {
  throw InputError(fmt::format(
      "{0} is given a fixed value and is varied (--vary {0}); one of the two would be right", key));
}

/// Refuses parameters that a point has from the sweep, that are no input, or that are fixed too.
void check_keys(const CLI::App& app, const SweepCommand& options,
                const std::vector<SweptParameter>& parameters) {
  for (const auto& [key, values] : parameters) {
    for (const char* own : {"help", "output", "threads", "quiet", "json", "plot", "vary"})
      if (key == own)
        throw InputError(
            fmt::format("--vary {}: --{} says how, not what is computed; a parameter of the lens, the sensor "
                        "or the command "
                        "would be right",
                        key, own));
    const bool sensor_entry = is_sensor_entry(app, key);
    const bool fixed = sensor_entry ? is_set(options.words, "--sensor-set", key.substr(sensor_prefix.size()))
                                    : is_given(options.words, key) || is_set(options.words, "--set", key);
    if (fixed) refuse_fixed(key);
  }
}

/// A second program of the same options that reads command lines and does nothing.
class CommandLineCheck {
 public:
  CommandLineCheck() {
    shared_.parse_only = true;
    add_commands(program_, shared_, {});
  }
  /// \returns what is wrong, or nothing.
  std::string complaint(std::vector<std::string> arguments) {
    std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
    try {
      program_.parse(std::move(arguments));
    } catch (const CLI::ParseError& error) {
      return usage_message(program_, error);
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  }
  /// An option of the command line last read that names an output, --output apart.
  std::string output_option() const {
    const CLI::App* at = &program_;
    while (!at->get_subcommands().empty()) at = at->get_subcommands().front();
    for (const std::string& name : output_options(*at))
      if (name != "--output") return name;
    return {};
  }

 private:
  CLI::App program_{"", "petzval"};
  Shared shared_;
};

}  // namespace

const CLI::App& swept_app(const CLI::App& program, const SweepCommand& options) {
  const CLI::App* command = program.get_subcommand(options.command);
  if (options.command != "lens") return *command;
  if (options.words.empty())
    throw InputError("sweep lens: which analysis? sweep lens mtf LENS --vary … would be right");
  for (const CLI::App* below : command->get_subcommands([](const CLI::App*) { return true; }))
    if (below->get_name() == options.words.front()) return *below;
  throw InputError(fmt::format("sweep lens: there is no command lens {}", options.words.front()));
}

std::vector<std::string> arguments_of(const CLI::App& app, const SweepCommand& options,
                                      const SweepPoint& point, const Shared& shared) {
  std::vector<std::string> arguments{options.command};
  arguments.insert(arguments.end(), options.words.begin(), options.words.end());
  bool seed = false;
  for (const auto& [key, value] : point) {
    if (key == label_key) continue;
    const CLI::Option* option = app.get_option_no_throw("--" + key);
    seed = seed || key == "seed";
    if (is_positional(options, key)) {
      arguments.insert(arguments.begin() + (options.command == "lens" ? 2 : 1), value);
    } else if (option != nullptr && option->get_items_expected_max() == 0) {
      arguments.push_back("--" + key + "=" + value);  // a flag: true or false
    } else if (option != nullptr) {
      arguments.insert(arguments.end(), {"--" + key, value});
    } else if (is_sensor_entry(app, key)) {
      arguments.insert(arguments.end(), {"--sensor-set", key.substr(sensor_prefix.size()) + "=" + value});
    } else {
      arguments.insert(arguments.end(), {"--set", key + "=" + value});
    }
  }
  arguments.insert(arguments.end(), {"--threads", std::to_string(shared.threads)});
  if (!seed) arguments.insert(arguments.end(), {"--seed", std::to_string(shared.seed)});
  arguments.insert(arguments.end(), {"--quiet", "--json"});
  return arguments;
}

void check_command_lines(const CLI::App& app, const SweepCommand& options,
                         const std::vector<SweptParameter>& parameters, const Shared& shared) {
  check_keys(app, options, parameters);
  SweepPoint first;
  for (const auto& [key, values] : parameters) first.emplace_back(key, values.front());
  CommandLineCheck check;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    for (const std::string& value : parameters[i].values) {
      SweepPoint point = first;
      point[i].second = value;
      std::vector<std::string> arguments = arguments_of(app, options, point, shared);
      if (options.makes_pictures()) arguments.insert(arguments.end(), {"-o", "point.png"});
      const std::string wrong = check.complaint(arguments);
      if (wrong.empty()) continue;
      // A word too many: the scene or lens stands there, and is varied.
      const bool word =
          wrong.find("not expected: ") != wrong.npos && wrong.find("not expected: -") == wrong.npos;
      for (const SweptParameter& parameter : parameters)
        if (word && is_positional(options, parameter.key)) refuse_fixed(parameter.key);
      const bool of_this = wrong.find("--" + parameters[i].key) != wrong.npos;
      throw InputError(of_this ? fmt::format("--vary {}={}: {}", parameters[i].key, value, wrong) : wrong);
    }
  const std::string output = check.output_option();
  if (!output.empty())
    throw InputError(
        fmt::format("{}: every point would write the same file; a sweep takes its numbers "
                    "and pictures only",
                    output));
}

std::string in_words_of_sweep(std::string error, const SweepPoint& point) {
  for (const auto& [key, value] : point) {
    const std::string said = fmt::format("--set {}={}", key, value);
    const std::size_t at = error.find(said);
    if (at == error.npos) continue;
    error.replace(at, said.size(), fmt::format("--vary {}={}", key, value));
    if (error.find(key + " is not a key") != error.npos)
      error += fmt::format("; there is no option --{} either", key);
  }
  return error;
}

}  // namespace petzval::app
