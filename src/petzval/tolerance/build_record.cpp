// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/field_values.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/lens/lens_file.h>
#include <petzval/tolerance/build_record.h>
#include <petzval/tolerance/tolerancing.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string_view>

namespace petzval {

namespace {

constexpr std::string_view first_line = "petzval record of builds 1\n", builds_line = "builds\n";

std::string numbers(const std::vector<double>& values) {
  return fmt::format("{:a}", fmt::join(values, " "));
}

std::string one_line(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  return text;
}

std::vector<std::pair<std::string, std::string>> facts_of(const Lens& lens, const ToleranceRequest& request,
                                                          std::uint64_t seed) {
  std::string tolerances;
  for (const Tolerance& each : tolerances_of(lens, request))
    tolerances += fmt::format("{}@{}-{}={:a} ", each.kind, each.first, each.last, each.limit);
  const JudgeRequest& judge = request.judge;
  return {{"lens", one_line(lens_to_json(lens))},
          {"tolerances", tolerances},
          {"distribution", fmt::format("{}", static_cast<int>(request.distribution))},
          {"seed", fmt::format("{}", seed)},
          {"merit", fmt::format("{} {:a}", judge.merit.name(), judge.merit.frequency_cpmm)},
          {"field type", std::string(to_string(judge.at.field_kind))},
          {"fields", numbers(judge.at.fields)},
          {"wavelengths", numbers(judge.at.wavelengths_nm)},
          {"azimuths", numbers(judge.azimuths_deg)},
          {"apertures", fmt::format("{}", static_cast<int>(judge.at.clip))},
          {"refocus", judge.refocus ? "yes" : "no"}};
}

/// The first line of a text, with its end, taken from it; empty where none ends.
std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos) return {};
  const std::string_view line = text.substr(0, end + 1);
  text.remove_prefix(end + 1);
  return line;
}

/// Numbers of a line; empty if one is none.
std::vector<double> numbers_in(std::string_view line) {
  const std::string text(line.substr(0, line.size() - 1));
  std::vector<double> found;
  for (const char* at = text.c_str(); *at != '\0';) {
    char* end = nullptr;
    found.push_back(std::strtod(at, &end));
    if (end == at) return {};
    at = end;
    while (*at == ' ') ++at;
  }
  return found;
}

}  // namespace

BuildRecord::BuildRecord(std::string path, const Lens& lens, const ToleranceRequest& request,
                         std::uint64_t seed)
    : path_(std::move(path)) {
  const auto facts = facts_of(lens, request, seed);
  std::error_code none;
  if (std::filesystem::exists(path_, none)) {
    const std::string text = read_whole_file(path_);
    std::filesystem::resize_file(path_, read(text, facts, points_of(lens, request.judge).size()));
  } else {
    std::string text(first_line);
    for (const auto& [name, value] : facts) text += name + ": " + value + '\n';
    write_whole_file(path_, text.append(builds_line));
  }
  file_.reset(std::fopen(path_.c_str(), "ab"));
  if (!file_) throw Failure(path_ + ": cannot be written");
}

std::size_t BuildRecord::read(const std::string& text, const Facts& facts, std::size_t points) {
  std::string_view rest(text);
  if (take_line(rest) != first_line)
    throw InputError(path_ + ": no record of builds; the name of a new file would be right");
  for (const auto& [name, value] : facts)
    if (take_line(rest) != name + ": " + value + '\n')
      throw InputError(
          fmt::format("{}: a record of other builds, not the same {}; the name of a new file would be right",
                      path_, name));
  if (take_line(rest) != builds_line) throw InputError(path_ + ": damaged before its builds");
  for (std::size_t line = facts.size() + 3;; ++line) {
    const std::string_view one = take_line(rest);
    if (one.empty()) return text.size() - rest.size();
    const std::vector<double> row = numbers_in(one);
    constexpr double most = 1e9;
    if (row.size() != 4 + points || !(row[0] >= 0 && row[0] < most))
      throw InputError(
          fmt::format("{}: line {}: not a build and its {} numbers; without this line the record "
                      "is whole",
                      path_, line, 3 + points));
    known_[static_cast<std::size_t>(row[0])] = {{row.begin() + 4, row.end()}, row[1], row[2], row[3]};
  }
}

const Judgement* BuildRecord::find(std::size_t build) const {
  const auto found = known_.find(build);
  return found == known_.end() ? nullptr : &found->second;
}

void BuildRecord::add(std::size_t build, const Judgement& judgement) {
  const std::string line = fmt::format("{} {:a} {:a} {:a} {}\n", build, judgement.overall, judgement.worst,
                                       judgement.refocus_mm, numbers(judgement.at_points));
  const std::lock_guard lock(writing_);
  if (std::fwrite(line.data(), 1, line.size(), file_.get()) != line.size() || std::fflush(file_.get()) != 0)
    throw Failure(path_ + ": cannot be written; is the disk full?");
}

}  // namespace petzval
