// SPDX-License-Identifier: BSD-3-Clause
#include "command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/analysis/surface_order.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/file_extension.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/glass/glass_file.h>
#include <petzval/lens/lens_file.h>
#include <petzval/lens/lens_states.h>
#include <petzval/simulate/mounting.h>
#include <petzval/tolerance/tolerancing.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "option_names.h"
#include "output_option.h"

namespace petzval::app {

std::string right_word(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  if (type.starts_with("FLOAT")) return "a number";
  if (type.starts_with("INT") || type.starts_with("UINT")) return "a whole number";
  return "a value";
}

namespace {

/// Set by SIGINT and SIGTERM.
volatile std::sig_atomic_t interrupted = 0;

/// CLI11 takes an empty word for 0, "nan" and "inf" for numbers, and wraps whole numbers below 0 around.
void refuse_odd_numbers(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options({})) {
    const std::string right = right_word(*option);
    if (right == "a value") continue;
    for (const std::string& word : option->results()) {
      if (word.empty())
        throw InputError(fmt::format("{}: an empty word; {} would be right", option->get_name(), right));
      std::string complaint;
      if (right == "a number" && !std::isfinite(std::strtod(word.c_str(), nullptr)))
        complaint = fmt::format("{} is not a number", word);
      if (option->get_type_name().starts_with("UINT")) complaint = whole_number()(word);
      if (!complaint.empty()) throw InputError(fmt::format("{}: {}", option->get_name(), complaint));
    }
  }
}

}  // namespace

Context context_of(const Shared& shared) {
  Context context;
  context.threads = shared.threads;
  context.seed = shared.seed;
  context.note = [&shared](const std::string& text) { note(shared, text); };
  const auto bar = std::make_shared<ProgressBar>(!shared.quiet);
  context.progress = [bar](double fraction, const std::string& what) {
    bar->update(fraction, what);
    return true;  // the context around the command hears of Ctrl-C
  };
  return context;
}

void stop_on_signals() {
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { interrupted = 1; });
}

CLI::App* add_command(CLI::App& parent, Shared& shared, const std::string& name,
                      const std::string& description, const std::string& example, bool prints_numbers,
                      std::function<void()> work) {
  CLI::App* command = parent.add_subcommand(name, description);
  command->footer("Example:\n  " + example);
  command->add_option("--threads", shared.threads, "Threads to use; 0: all (results do not depend on it)")
      ->check(CLI::Range(0, 4096));
  command->add_option("--seed", shared.seed, "Seed of every random number")->check(whole_number());
  command->add_flag("--quiet", shared.quiet, "No notes and no progress bar");
  if (prints_numbers) command->add_flag("--json", shared.json, "Numbers as JSON on stdout");
  command->callback([&shared, command, work = std::move(work)] {
    refuse_odd_numbers(*command);
    if (shared.parse_only) return;
    check_outputs(*command);
    // Whatever the command does, its threads are limited and Ctrl-C ends it.
    Context context;
    context.threads = shared.threads;
    context.progress = [](double, const std::string&) { return interrupted == 0; };
    run_within(context, [&](const ProgressCallback&) { work(); });
  });
  return command;
}

namespace {

/// What does what people try first, where the nearest name would mislead.
std::string advice_on(const std::string& way, const std::string& option) {
  struct Advice {
    const char *way, *option, *words;
  };
  static constexpr Advice known[] = {
      {"petzval lens", "--object-distance",
       "--focus 400mm puts the object there and focuses on it; --set object_distance_mm=400 moves the object "
       "alone"},
      {"petzval lens", "--distance", "--focus 400mm puts the object there and focuses on it"},
      {"petzval render", "--scale",
       "--size 200x150 makes the picture smaller, --scene-unit says how long the scene's unit is in mm"},
      {"petzval render", "--focus-distance", "--focus 1.5m (a distance with its unit) would be right"},
      {"petzval render", "--vary", "petzval sweep render has it: a range of focus, f-number, camera, lens"},
      {"petzval render", "--exposure-value", "--exposure ev:12 would be right"},
      {"petzval render", "--fov", "--field-of-view would be right, for a camera without a lens"},
      {"petzval image", "--focus-distance", "--focus 1.5m (a distance with its unit) would be right"},
      {"petzval image", "--distance", "--scene-distance 400mm would be right"},
      {"petzval image", "--lux", "--illuminance 500 would be right"},
      {"petzval image", "--iso", "--gain would be right; the output tells the ISO speed of the sensor"},
      {"petzval lens", "--lp-per-mm", "--frequencies 100 (cycles/mm) would be right"},
      {"petzval image", "--size",
       "the sensor says how many pixels there are: --sensor 200x150@5, or --sensor-set columns=200 "
       "--sensor-set rows=150, would be right"},
      {"petzval image", "--aperture", "--f-number would be right"},
      {"petzval target", "--aperture", "--f-number would be right"},
      {"petzval lens", "--aperture", "--f-number would be right"}};
  for (const Advice& each : known)
    if (way.starts_with(each.way) && option == each.option) return each.words;
  return "";
}

/// The same for commands.
std::string advice_on_command(const std::string& way, const std::string& word) {
  struct Advice {
    const char *way, *word, *words;
  };
  static constexpr Advice known[] = {
      {"petzval lens", "dof", "lens for-sensor tells the depth of field"},
      {"petzval lens", "fov", "lens for-sensor tells the field of view"},
      {"petzval lens", "set", "--set 'surfaces[4].thickness_mm=0.7' alters the lens in every command"},
      {"petzval lens", "show", "lens info tells numbers, lens draw makes a drawing"},
      {"petzval", "mtf", "lens mtf computes it of a lens, sfr measures it in a picture"},
      {"petzval", "psf", "lens psf would be right"},
      {"petzval", "list", "lens list, sensor list and scene list would be right"}};
  for (const Advice& each : known)
    if (way == each.way && word == each.word) return each.words;
  return "";
}

/// \throws InputError for a word like an option that the command has not. \param way  of commands to this
/// one.
void refuse_unknown_options(const CLI::App& command, const std::string& way,
                            const std::vector<std::string>& words) {
  if (command.get_allow_extras()) return;  // they are those of another command
  std::vector<std::string> names{"--help", "--help-all"};
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  for (const std::string& word : words) {
    if (word == "--") return;
    const std::string name = word.substr(0, word.find('='));
    if (!name.starts_with("--") || std::find(names.begin(), names.end(), name) != names.end()) continue;
    if (const std::string advice = advice_on(way, name); !advice.empty())
      throw InputError(fmt::format("{} has no option {}; {}", way, name, advice));
    throw InputError(fmt::format("{} has no option {}; the nearest are {} (see {} --help)", way, name,
                                 fmt::join(nearest_names(name, names), ", "), way));
  }
}

/// CLI11 drops the empty words of lists and would take 1,,2 for two numbers.
void refuse_empty_words(const CLI::App& command, const std::vector<std::string>& words) {
  const CLI::Option* list = nullptr;
  for (const std::string& word : words) {
    if (word == "--") return;
    std::string text = word;
    if (word.size() > 1 && word[0] == '-' && (word[1] == '-' || std::isalpha(word[1]))) {
      const std::size_t equals = std::min(word.find('='), word.size());
      list = command.get_option_no_throw(word.substr(0, equals));
      if (list && list->get_delimiter() != ',') list = nullptr;
      if (equals == word.size()) continue;
      text = word.substr(equals + 1);
    }
    if (!list) continue;
    for (const std::string& part : split_at(text, ','))
      if (trimmed(part).empty())
        throw InputError(fmt::format("{} {}: an empty word; {} would be right", list->get_name(),
                                     quotable(text), right_word(*list)));
  }
}

}  // namespace

void refuse_unknown_words(const CLI::App& program, const std::vector<std::string>& words) {
  const CLI::App* at = &program;
  std::string way = program.get_name();
  for (const std::string& word : words) {
    if (word.starts_with('-')) break;
    const std::vector<const CLI::App*> known = at->get_subcommands([](const CLI::App*) { return true; });
    if (known.empty()) break;
    std::vector<std::string> names;
    for (const CLI::App* command : known) names.push_back(command->get_name());
    const auto found = std::find(names.begin(), names.end(), word);
    if (found == names.end()) {
      if (const std::string advice = advice_on_command(way, word); !advice.empty())
        throw InputError(fmt::format("{} has no command '{}'; {}", at->get_name(), word, advice));
      throw InputError(fmt::format("{} has no command '{}'; the nearest are {} (see {} --help)",
                                   at->get_name(), word, fmt::join(nearest_names(word, names), ", "), way));
    }
    way += " " + word;
    at = known[static_cast<std::size_t>(found - names.begin())];
  }
  refuse_unknown_options(*at, way, words);
  refuse_empty_words(*at, words);
}

namespace {

/// Takes words that are numbers and fulfil `holds`.
CLI::Validator number_check(bool (*holds)(double), const char* right) {
  const auto complaint = [=](const std::string& word) {
    const auto number = parse_number(word);
    if (number && holds(*number)) return std::string();
    return word.empty() ? fmt::format("an empty word; {} would be right", right)
                        : fmt::format("{} is not {}", word, right);
  };
  return CLI::Validator(complaint, right);
}

}  // namespace

CLI::Validator positive_number() {
  return number_check([](double value) { return value > 0; }, "a number above 0");
}

CLI::Validator number_not_negative() {
  return number_check([](double value) { return value >= 0; }, "a number from 0 on");
}

CLI::Validator finite_number() {
  return number_check([](double value) { return std::isfinite(value); }, "a number");
}

CLI::Validator whole_number() {
  return CLI::Validator(
      [](const std::string& word) {
        constexpr std::size_t most_digits = 19;
        const bool right =
            !word.empty() && word.size() <= most_digits && word.find_first_not_of("0123456789") == word.npos;
        return right ? std::string() : fmt::format("{} is not a whole number from 0 on", word);
      },
      "a whole number from 0 on");
}

void GlassChoice::add_to(CLI::App& command) {
  command
      .add_option(
          "--glass-catalogue", paths,
          "Glasses of your own, searched before the bundled ones: .agf, a refractiveindex.info .yml, or a "
          "folder of them (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
}

GlassCatalogue GlassChoice::read(const Shared& shared) const {
  std::vector<std::string> all = paths;
  if (const char* given = std::getenv("PETZVAL_GLASS_CATALOGUES"))
    for (const std::string& path : CLI::detail::split(given, ':'))
      if (!path.empty()) all.push_back(path);
  std::vector<Glass> glasses;
  for (const std::string& path : all) {
    GlassFile file = read_glass_files(path);
    for (const std::string& line : file.notes) note(shared, line);
    std::move(file.glasses.begin(), file.glasses.end(), std::back_inserter(glasses));
  }
  return glasses.empty() ? GlassCatalogue::bundled() : GlassCatalogue::bundled().with(std::move(glasses));
}

void LensChoice::add_to(CLI::App& command, bool positional, bool required) {
  CLI::Option* option =
      command.add_option(positional ? "lens" : "--lens", path_or_name, "Lens file or name of a bundled lens");
  if (required) option->required();
  add_settings_to(command);
}

void LensChoice::add_settings_to(CLI::App& command) {
  command
      .add_option("--state", state,
                  "Zoom or focus position, by name or by number from 0 on; between two numbers, in "
                  "proportion (lens info lists them)")
      ->check(CLI::Validator(
          [](const std::string& word) { return word.empty() ? "an empty word" : std::string(); },
          "NAME|NUMBER"));
  command.add_option("--set", settings, "Alter the lens: surfaces[4].thickness_mm=0.5 (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
  command
      .add_option("--substitute", substitutions,
                  "Use another glass: LAK10C=CDGM:H-LAK10, or by nd/Vd SK1=1.61025/56.71 (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
  glasses.add_to(command);
  if (!offers_builds) return;
  CLI::Option* number = command.add_option(
      "--build", build,
      "Take the lens as number N off the line has it, focused: 0, 1, … (see lens tolerance)");
  command
      .add_option(
          "--grade", grade,
          fmt::format("Of the tolerances of builds: {}; default: precision, unless the lens has its own",
                      fmt::join(tolerance_grades(), ", ")))
      ->check(CLI::IsMember(std::vector<std::string>(tolerance_grades().begin(), tolerance_grades().end())))
      ->needs(number);
}

std::vector<std::string> LensChoice::given_settings() const {
  std::vector<std::string> names;
  if (!state.empty()) names.emplace_back("--state");
  if (!settings.empty()) names.emplace_back("--set");
  if (!substitutions.empty()) names.emplace_back("--substitute");
  if (build) names.emplace_back("--build");
  if (!glasses.paths.empty()) names.emplace_back("--glass-catalogue");
  return names;
}

LensChoice LensChoice::for_lens(const std::string& name) const {
  LensChoice choice = *this;
  choice.path_or_name = name;
  return choice;
}

void LensChoice::require_all_substituted() const {
  for (const std::string& text : substitutions)
    if (const std::string from = text.substr(0, text.find('=')); !substituted->contains(from))
      throw InputError(fmt::format("--substitute {}: none of the lenses has the glass {}", text, from));
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
  options.glasses = glasses.read(shared);
  options.substituted = substituted;
  LensFile file = read_lens(path_or_name, options);
  for (const std::string& line : file.notes) note(shared, line);
  if (!state.empty()) file.lens = in_state(file.lens, state, options);
  const Lens before = file.lens;
  for (const std::string& setting : settings) file.lens = with_setting(file.lens, setting, options);
  require_surfaces_in_order(file.lens);
  if (before.object_distance_mm != file.lens.object_distance_mm)
    note_unfocused_object(before, file.lens, context_of(shared));
  if (!build) return std::move(file.lens);
  ToleranceRequest request;
  request.grade = grade;
  return build_off_the_line(file.lens, request, shared.seed, *build);
}

void note(const Shared& shared, const std::string& message) {
  if (!shared.quiet) fmt::print(stderr, "petzval: note: {}\n", with_option_names(message));
}

void require_extension(const std::string& path, const std::vector<std::string>& extensions,
                       const std::string& what) {
  const std::string extension = extension_of(path);
  if (std::find(extensions.begin(), extensions.end(), extension) == extensions.end())
    throw InputError(path, fmt::format("{} is written as {}", what, fmt::join(extensions, ", ")));
}

}  // namespace petzval::app
