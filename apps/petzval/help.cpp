// SPDX-License-Identifier: BSD-3-Clause
#include "help.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/version.h>

#include <algorithm>
#include <set>

namespace petzval::app {

namespace {

/// Up to so many options are all shown.
constexpr std::size_t few_options = 16;

/// Shown without --help-all.
const std::set<std::string> everyday{"--help",          "--lens",          "--optics",
                                     "--set",           "--f-number",      "--focus",
                                     "--sensor",        "--output",        "--wavelengths",
                                     "--fields",        "--frequencies",   "--json",
                                     "--csv",           "--plot",          "--illuminant",
                                     "--exposure",      "--white-balance", "--scene-distance",
                                     "--scene-angle",   "--spp",           "--noise",
                                     "--size",          "--autofocus",     "--zone",
                                     "--zones",         "--pinhole",       "--checkpoint",
                                     "--quiet",         "--rectangle",     "--half-plane",
                                     "--polygons",      "--text",          "--chart",
                                     "--sigma",         "--pixel-pitch",   "--field",
                                     "--wavelength",    "--polychromatic", "--over-field",
                                     "--radii",         "--method",        "--roi",
                                     "--annotate",      "--profile",       "--gain",
                                     "--demosaic",      "--brightness",    "--tone",
                                     "--denoise",       "--seed",          "--scene-depth",
                                     "--rays",          "--depth",         "--psf",
                                     "--spacing",       "--field-type",    "--by-light",
                                     "--vary",          "--black",         "--order",
                                     "--film-distance", "--dry-run",       "--preview",
                                     "--list",          "--camera-at",     "--look-at",
                                     "--layers",        "--frames",        "--clip",
                                     "--denoise-light"};

struct HelpGroup {
  const char* heading;
  std::vector<std::string> options;  ///< a word that ends in "*" stands for all that begin so
};

/// What has no place here stands first, under "Options".
const std::vector<HelpGroup>& help_groups() {
  static const std::vector<HelpGroup> groups{
      {"Scene",
       {"--scene-*", "--illuminant", "--wavelengths", "--sky", "--absolute-spectra", "--near", "--far",
        "--skip-unsupported", "--list-unsupported", "--surround", "--camera-at", "--look-at",
        "--field-of-view", "--light-scale"}},
      {"Lens",
       {"--lens", "--optics", "--set", "--substitute", "--glass-catalogue", "--f-number",
        "--aperture-diameter", "--blades", "--blade-rotation", "--apertures", "--ignore-apertures",
        "--fresnel", "--coating", "--absorption", "--pinhole"}},
      {"Focus",
       {"--focus", "--film-distance", "--image-distance", "--move-lens", "--autofocus", "--zone", "--zones",
        "--focus-*", "--show-zones"}},
      {"Sensor", {"--sensor", "--sensor-set", "--film-diagonal"}},
      {"Output",
       {"--output", "--picture", "--bits", "--plot", "--csv", "--depth", "--normals", "--albedo", "--layers",
        "--light-groups", "--white", "--display", "--preview", "--json"}}};
  return groups;
}

bool stands_for(const std::string& pattern, const std::string& name) {
  return pattern.ends_with('*') ? name.starts_with(pattern.substr(0, pattern.size() - 1)) : pattern == name;
}

/// "--output" of "-o,--output"; "scene" of a positional.
std::string long_name(const CLI::Option& option) {
  const std::vector<std::string>& names = option.get_lnames();
  return names.empty() ? option.get_name() : "--" + names.front();
}

constexpr const char* default_group = "Options";

void set_groups(CLI::App& command, bool all) {
  const std::vector<CLI::Option*> options = command.get_options();
  const bool hides = !all && options.size() > few_options;
  for (CLI::Option* option : options) {
    if (option->get_positional()) continue;
    const std::string name = long_name(*option);
    if (hides) {
      option->group(everyday.contains(name) || option->get_required() ? default_group : "");
    } else if (options.size() > few_options && option->get_group() == default_group) {
      for (const HelpGroup& group : help_groups())
        for (const std::string& pattern : group.options)
          if (stands_for(pattern, name)) option->group(group.heading);
    }
  }
  if (hides) {
    const std::string footer = command.get_footer();
    command.footer("--help-all shows all options.\n\n" + footer);
  }
}

/// Calls visit(command, "lens mtf") for a command and all below it.
template <class Visit>
void each_command(const CLI::App& command, const std::string& way, Visit&& visit) {
  visit(command, way);
  for (const CLI::App* below : command.get_subcommands([](const CLI::App*) { return true; }))
    each_command(*below, way.empty() ? below->get_name() : way + " " + below->get_name(), visit);
}

std::vector<std::string> command_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* below : command.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(below->get_name());
  return names;
}

/// What an option or a positional may be: the words of a choice, or the names of what is bundled.
std::vector<std::string> choices(const CLI::Option& option) {
  const std::string type = option.get_type_name(), name = long_name(option);
  const std::size_t open = type.find('{'), close = type.rfind('}');
  if (open != std::string::npos && close != std::string::npos)
    return CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
  if (name == "lens" || name == "--lens") return all_bundled_names("lenses", ".json");
  if (name == "--sensor") return bundled_names("sensors", ".json");
  if (name == "--focus") return {"auto", "design", "infinity", "best-spot", "best-mtf@"};
  return {};
}

std::vector<std::string> dashed_names(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

/// Text for troff: hyphens that are typed, and no requests by accident.
std::string troff(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '-')
      out += "\\-";
    else if (c == '\\')
      out += "\\e";
    else if (out.empty() && (c == '.' || c == '\''))
      out += std::string("\\&") + c;
    else
      out += c;
  }
  return out;
}

}  // namespace

void arrange_help(CLI::App& program, std::vector<std::string>& words) {
  const auto asked = std::find(words.begin(), words.end(), "--help-all");
  const bool all = asked != words.end();
  if (all) *asked = "--help";
  const bool any = all || std::find_if(words.begin(), words.end(), [](const std::string& word) {
                            return word == "--help" || word == "-h";
                          }) != words.end();
  if (!any) return;
  each_command(program, "", [&](const CLI::App& command, const std::string&) {
    auto& own = const_cast<CLI::App&>(command);
    set_groups(own, all);
  });
}

std::string bash_completion(const CLI::App& program) {
  std::string ways, values, options;
  each_command(program, "", [&](const CLI::App& command, const std::string& way) {
    const std::string start = way.empty() ? "" : " " + way;
    std::vector<std::string> names = command_names(command), words;
    for (const std::string& name : names)
      ways += fmt::format("{}'{} {}'", ways.empty() ? "" : "|", start, name);
    for (const CLI::Option* option : command.get_options()) {
      const std::vector<std::string> allowed = choices(*option), dashed = dashed_names(*option);
      words.insert(words.end(), dashed.begin(), dashed.end());
      if (dashed.empty()) names.insert(names.end(), allowed.begin(), allowed.end());
      if (allowed.empty()) continue;
      for (const std::string& name : dashed)
        values += fmt::format("    '{} {}') choices='{}' ;;\n", start, name, fmt::join(allowed, " "));
    }
    options += fmt::format("    '{}') options='{} --help-all'; names='{}' ;;\n", start, fmt::join(words, " "),
                           fmt::join(names, " "));
  });
  return fmt::format(R"(# Completion of petzval {0} for bash, printed by `petzval completion`.
_petzval() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}} way= word i choices= options= names=
  for ((i = 1; i < COMP_CWORD; ++i)); do
    word=${{COMP_WORDS[i]}}
    case "$way $word" in
      {1}) way+=" $word" ;;
      *) break ;;
    esac
  done
  case "$way $previous" in
{2}  esac
  case "$way" in
{3}  esac
  if [[ -n $choices ]]; then
    COMPREPLY=($(compgen -W "$choices" -- "$current"))
  elif [[ $current == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$current"))
  elif [[ $previous != -* ]]; then
    COMPREPLY=($(compgen -W "$names" -- "$current"))
  fi
}}
complete -o default -F _petzval petzval
)",
                     version(), ways, values, options);
}

std::string man_page(const CLI::App& program) {
  std::string text = fmt::format(
      ".TH PETZVAL 1 \"\" \"petzval {}\" \"User Commands\"\n.SH NAME\npetzval \\- {}\n.SH SYNOPSIS\n.B "
      "petzval\n"
      ".I COMMAND\n.RI [ OPTIONS ]\n.SH COMMANDS\n",
      version(), "digital\\-camera simulation from the glass up");
  each_command(program, "", [&](const CLI::App& command, const std::string& way) {
    if (way.empty()) return;
    text += fmt::format(".SS petzval {}\n{}.\n", troff(way), troff(command.get_description()));
    for (const CLI::Option* option : command.get_options()) {
      const std::vector<std::string> dashed = dashed_names(*option);
      const bool takes = option->get_items_expected_max() > 0;
      const std::vector<std::string> allowed =
          takes && dashed.size() > 0 ? choices(*option) : std::vector<std::string>();
      const std::string name =
          dashed.empty() ? option->get_name() : fmt::format("{}", fmt::join(dashed, ", "));
      text += fmt::format(".TP\n.B {}\n{}{}\n", troff(name), troff(option->get_description()),
                          allowed.empty() ? "" : troff(fmt::format(" [{}]", fmt::join(allowed, ", "))));
    }
    if (!command.get_footer().empty()) {
      text += ".PP\n.nf\n";
      for (const std::string& line : CLI::detail::split(command.get_footer(), '\n'))
        if (!line.empty()) text += troff(line) + "\n";
      text += ".fi\n";
    }
  });
  text +=
      ".SH EXIT STATUS\n0: done. 1: something failed that is no fault of the input (a full disk). 2: the "
      "input or the "
      "command line is wrong; one line on standard error says what would be right. 130: stopped by "
      "Ctrl\\-C.\n"
      ".SH ENVIRONMENT\n.TP\n.B PETZVAL_GLASS_CATALOGUES\nGlass catalogues of your own, parted by colons.\n";
  return text;
}

void add_help_commands(CLI::App& program) {
  program.add_subcommand("completion", "Completion of the command line for bash, as a script")
      ->footer("Example:\n  petzval completion")
      ->callback([&program] { fmt::print("{}", bash_completion(program)); });
  program.add_subcommand("manual", "The man page: petzval manual | man -l -")
      ->footer("Example:\n  petzval manual")
      ->callback([&program] { fmt::print("{}", man_page(program)); });
}

}  // namespace petzval::app
