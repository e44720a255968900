// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/lens/formats/zmx_configurations.h>
#include <petzval/lens/lens.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace petzval {

namespace {

/// Operands that alter no ray here: place holders, vignetting factors, weights and titles.
const std::set<std::string> idle_operands{"MOFF", "FVDX", "FVDY", "FVCX", "FVCY",
                                          "FVAN", "FLWT", "WLWT", "LTTL", "CWGT"};
const std::set<std::string> read_operands{"THIC", "CRVT", "CURV", "CONN", "GLSS", "SDIA",
                                          "APMN", "APMX", "STPS", "APER", "XFIE", "YFIE"};
/// Solves whose numbers would have to follow each configuration.
const std::set<std::string> dependent_solves{"PZUP", "PKUP", "PPAR", "MARA", "CHRA"};

/// A thickness from which on OpticStudio takes the object for infinitely far away.
constexpr double configuration_infinite_distance = 1e10;

std::string unquoted(std::string word) {
  std::erase(word, '"');
  return word;
}

ZmxRecord& record_of(ZmxBlock& block, const std::string& keyword, int line) {
  for (auto record = block.records.rbegin(); record != block.records.rend(); ++record)
    if (record->keyword == keyword) return *record;
  block.records.push_back({line, keyword, {}, ""});
  return block.records.back();
}

void put_value(ZmxBlock& block, const std::string& keyword, std::size_t i, const std::string& value,
               int line) {
  ZmxRecord& record = record_of(block, keyword, line);
  if (record.values.size() <= i) record.values.resize(i + 1, "0");
  record.values[i] = value;
}

void put_glass(ZmxBlock& block, const std::string& name, int line) {
  if (name.empty()) {
    std::erase_if(block.records, [](const ZmxRecord& record) { return record.keyword == "GLAS"; });
    return;
  }
  put_value(block, "GLAS", 0, name, line);
  put_value(block, "GLAS", 1, "0", line);
}

/// Into the CLAP or the FLAP that the surface has, or a CLAP that it gets.
void put_aperture_radius(ZmxBlock& block, std::size_t i, const std::string& value, int line) {
  put_value(block, block.find("FLAP") ? "FLAP" : "CLAP", i, value, line);
}

void put_system_aperture(ZmxFile& file, const ZmxRecord& operand, const std::string& value) {
  for (const char* keyword : {"ENPD", "FNUM", "OBNA"})
    if (file.header.find(keyword)) return put_value(file.header, keyword, 0, value, operand.line);
  file.fail(file.header, operand.line, "APER: the aperture is that of the stop (FLOA), which has no value");
}

void put_field(ZmxFile& file, const ZmxRecord& operand, std::size_t number, const std::string& value) {
  const bool x = operand.keyword == "XFIE";
  for (const char* keyword : {x ? "XFLN" : "YFLN", x ? "XFLD" : "YFLD"})
    if (const ZmxRecord* record = file.header.find(keyword); record && number >= 1 && record->has(number - 1))
      return put_value(file.header, keyword, number - 1, value, operand.line);
  file.fail(file.header, operand.line,
            fmt::format("{} {}: the file has no such field", operand.keyword, number));
}

void put_stop(ZmxFile& file, const ZmxRecord& operand, double surface) {
  const auto count = static_cast<double>(file.surfaces.size());
  if (!(surface >= 1 && surface + 1 < count) || surface != std::floor(surface))
    file.fail(file.header, operand.line,
              fmt::format("STPS: the file has no surface {:g} to be the stop", surface));
  for (ZmxBlock& block : file.surfaces)
    std::erase_if(block.records, [](const ZmxRecord& record) { return record.keyword == "STOP"; });
  file.surfaces[static_cast<std::size_t>(surface)].records.push_back({operand.line, "STOP", {}, ""});
}

void apply_operand(ZmxFile& file, const ZmxRecord& operand) {
  const std::string& word = operand.keyword;
  const double place = file.number(file.header, operand, 0);
  const std::string value = unquoted(operand.values[2]);
  if (word != "GLSS") file.number(file.header, operand, 2);  // complains of what is no number
  if (!(place >= 0) || place != std::floor(place) || place > 1e6)
    file.fail(file.header, operand.line,
              fmt::format("{}: {:g} is no number of a surface or field", word, place));
  const auto number = static_cast<std::size_t>(place);
  if (word == "APER") return put_system_aperture(file, operand, value);
  if (word == "XFIE" || word == "YFIE") return put_field(file, operand, number, value);
  if (word == "STPS") return put_stop(file, operand, file.number(file.header, operand, 2));
  if (number >= file.surfaces.size())
    file.fail(file.header, operand.line, fmt::format("{} {}: the file has no such surface", word, number));
  ZmxBlock& block = file.surfaces[number];
  if (word == "THIC") {
    const bool infinite =
        number == 0 && std::abs(file.number(file.header, operand, 2)) >= configuration_infinite_distance;
    put_value(block, "DISZ", 0, infinite ? "INFINITY" : value, operand.line);
  } else if (word == "CRVT" || word == "CURV") {
    put_value(block, "CURV", 0, value, operand.line);
  } else if (word == "CONN") {
    put_value(block, "CONI", 0, value, operand.line);
  } else if (word == "GLSS") {
    put_glass(block, value, operand.line);
  } else if (word == "SDIA") {
    put_value(block, "DIAM", 0, value, operand.line);
    put_value(block, "DIAM", 1, "1", operand.line);
  } else {
    put_aperture_radius(block, word == "APMX" ? 1 : 0, value, operand.line);
  }
}

double thickness_of(const ZmxFile& file, const ZmxBlock& block) {
  const ZmxRecord* record = block.find("DISZ");
  return record ? file.number(block, *record, 0) : 0;
}

/// TCOM i total: the gaps of surface i and of this one together. TOLE i total: all from i to this one.
void solve_gaps(ZmxFile& file) {
  for (std::size_t i = 0; i < file.surfaces.size(); ++i)
    for (const char* keyword : {"TCOM", "TOLE"}) {
      const ZmxRecord* solve = file.surfaces[i].find(keyword);
      if (!solve) continue;
      const double from = file.number(file.surfaces[i], *solve, 0);
      if (!(from >= 0 && from < static_cast<double>(i)) || from != std::floor(from))
        file.fail(file.surfaces[i], solve->line,
                  fmt::format("{} must name a surface in front of it", keyword));
      const auto first = static_cast<std::size_t>(from);
      double rest = file.number(file.surfaces[i], *solve, 1) - thickness_of(file, file.surfaces[first]);
      const bool all = solve->keyword == "TOLE";
      for (std::size_t j = first + 1; all && j < i; ++j) rest -= thickness_of(file, file.surfaces[j]);
      put_value(file.surfaces[i], "DISZ", 0, number_text(rest), solve->line);
    }
}

}  // namespace

std::size_t zmx_configuration_count(const ZmxFile& file) {
  const ZmxRecord* record = file.header.find("MNUM");
  const double count = record ? file.number_or(file.header, *record, 0, 1) : 1;
  if (record &&
      (!(count >= 1 && count <= static_cast<double>(LensStates::most)) || count != std::floor(count)))
    file.fail(file.header, record->line,
              fmt::format("MNUM must be a number of configurations, 1 to {}", LensStates::most));
  return static_cast<std::size_t>(count);
}

std::string zmx_configurations_fault(const ZmxFile& file) {
  std::set<std::string> unknown;
  for (const ZmxRecord& operand : file.operands)
    if (!read_operands.contains(operand.keyword) && !idle_operands.contains(operand.keyword))
      unknown.insert(quotable(operand.keyword));
  for (const ZmxBlock& block : file.surfaces)
    for (const ZmxRecord& record : block.records)
      if (dependent_solves.contains(record.keyword)) unknown.insert(record.keyword);
  return unknown.empty() ? "" : fmt::format("{} are not modelled", fmt::join(unknown, ", "));
}

ZmxFile zmx_configuration(const ZmxFile& file, std::size_t number) {
  ZmxFile one = file;
  std::set<std::pair<std::string, std::string>> all, given;
  for (const ZmxRecord& operand : file.operands) {
    if (!read_operands.contains(operand.keyword)) continue;
    const std::pair<std::string, std::string> what{operand.keyword, operand.has(0) ? operand.values[0] : ""};
    all.insert(what);
    if (file.number(file.header, operand, 1) != static_cast<double>(number)) continue;
    if (!operand.has(2))
      file.fail(file.header, operand.line,
                fmt::format("{} {} misses the value of configuration {}", what.first, what.second, number));
    given.insert(what);
    apply_operand(one, operand);
  }
  for (const auto& what : all)
    if (!given.contains(what))
      file.fail(file.header, file.header.find("MNUM")->line,
                fmt::format("{} {} misses the value of configuration {}", what.first, quotable(what.second),
                            number));
  solve_gaps(one);
  return one;
}

bool zmx_solves_image(const ZmxFile& file) {
  const ZmxBlock& last = file.surfaces[file.surfaces.size() - 2];
  const ZmxRecord* solve = last.find("MAZH");
  return solve && file.number_or(last, *solve, 0, 0) == 0;
}

}  // namespace petzval
