// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/glass/packed_catalogue.h>
#include <petzval/lens/formats/seq.h>
#include <petzval/lens/formats/seq_zoom.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

namespace petzval {

namespace {

/// Titles, weights, vignetting factors, controls and couplings: no rays of ours.
const std::set<std::string> idle_when_zoomed{"TIT", "WTF", "WTW", "VUX", "VLX", "VUY", "VLY",
                                             "THC", "CCY", "GLC", "KC",  "PIM", "RED", "POS"};
const std::set<std::string> read_when_zoomed{"THI", "RDY", "CUY", "K",   "GLA", "GL1", "CIR",
                                             "STO", "EPD", "FNO", "NA",  "NAO", "YAN", "YOB",
                                             "YIM", "YRI", "XAN", "XOB", "XIM", "XRI"};

bool is_field_list(const std::string& name) {
  return name.size() == 3 && (name[0] == 'X' || name[0] == 'Y') &&
         (name.ends_with("AN") || name.ends_with("OB") || name.ends_with("IM") || name.ends_with("RI"));
}

/// The number of "F2".
std::optional<std::size_t> field_number(const std::string& word) {
  if (word.size() < 2 || (word[0] != 'F' && word[0] != 'f')) return {};
  const auto number = parse_integer(word.substr(1));
  if (!number || *number < 1) return {};
  return static_cast<std::size_t>(*number);
}

/// One entry of a list of fields, in the last command that gives it.
void put_zoomed_field(std::vector<SeqCommand>& commands, const SeqCommand& zoomed, std::size_t number,
                      const std::string& value, const SeqContext& context) {
  const auto list = std::find_if(commands.rbegin(), commands.rend(),
                                 [&](const SeqCommand& each) { return each.name == zoomed.name; });
  if (list == commands.rend() || !list->has(number - 1))
    context.fail(zoomed, fmt::format("F{} is zoomed (ZOO) and is not among the fields", number));
  list->words[number - 1] = value;
}

}  // namespace

SeqZoom seq_zoom(const std::vector<SeqCommand>& commands, const SeqContext& context) {
  SeqZoom zoom;
  for (const SeqCommand& command : commands) {
    if (command.name != "ZOO") {
      zoom.commands.push_back(command);
    } else if (command.has(0) && parse_number(command.words[0])) {
      const double count = context.number(command, 0);
      if (!(count >= 1 && count <= static_cast<double>(LensStates::most)) || count != std::floor(count))
        context.fail(command, fmt::format("must be a number of zoom positions, 1 to {}", LensStates::most));
      zoom.positions = static_cast<std::size_t>(count);
    } else if (command.has(0)) {
      constexpr std::size_t letters_that_count = 3;
      const std::string name = upper_case(command.words[0]).substr(0, letters_that_count);
      zoom.zoomed.push_back({command.line, name, {command.words.begin() + 1, command.words.end()}});
    }
  }
  return zoom;
}

std::vector<SeqCommand> seq_at_position(const SeqZoom& zoom, std::size_t position,
                                        const SeqContext& context) {
  std::vector<SeqCommand> commands = zoom.commands;
  for (const SeqCommand& each : zoom.zoomed) {
    if (idle_when_zoomed.contains(each.name)) continue;
    if (!read_when_zoomed.contains(each.name))
      context.fail(each, "differs between zoom positions (ZOO), which is not modelled");
    const bool qualified = each.has(0) && (seq_surface_name(each.words[0]) || field_number(each.words[0]));
    const std::size_t first = qualified ? 1 : 0;
    if (each.words.size() - std::min(first, each.words.size()) != zoom.positions)
      context.fail(each, fmt::format("has {} values for {} zoom positions (ZOO)",
                                     each.words.size() - std::min(first, each.words.size()), zoom.positions));
    const std::string& value = each.words[first + position];
    const auto field = qualified ? field_number(each.words[0]) : std::nullopt;
    if (field && is_field_list(each.name)) {
      put_zoomed_field(commands, each, *field, value, context);
      continue;
    }
    SeqCommand one{each.line, each.name, {}};
    if (qualified) one.words.push_back(each.words[0]);
    one.words.push_back(value);
    commands.push_back(std::move(one));
  }
  return commands;
}

}  // namespace petzval
