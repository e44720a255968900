// SPDX-License-Identifier: BSD-3-Clause
// A sweep's points from a table that a program or a spreadsheet wrote.
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>

#include <algorithm>

#include "sweep_points.h"

namespace petzval::app {

namespace {

/// The cells of a line; those in double quotes may hold commas.
std::vector<std::string> cells_of(std::string_view line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      cells.emplace_back();
    } else if (c != '\r') {
      cells.back() += c;
    }
  }
  for (std::string& cell : cells) {
    const std::size_t begin = std::min(cell.find_first_not_of(" \t"), cell.size());
    cell = cell.substr(begin, cell.find_last_not_of(" \t") + 1 - begin);
  }
  return cells;
}

}  // namespace

std::vector<SweepPoint> read_sweep_points(const std::string& path) {
  const std::string text = read_whole_file(path);
  std::vector<std::string> keys;
  std::vector<SweepPoint> points;
  std::string_view rest = text;
  for (int number = 1; !rest.empty(); ++number) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (line.find_first_not_of(" \t\r") == line.npos || line.starts_with('#')) continue;
    const std::vector<std::string> cells = cells_of(line);
    if (keys.empty()) {
      keys = cells;
      for (const std::string& key : keys)
        if (key.empty() || std::count(keys.begin(), keys.end(), key) > 1)
          throw InputError(
              path, number,
              "the first line names the parameters, each once: label,exposure,seed would be right");
      continue;
    }
    if (cells.size() != keys.size())
      throw InputError(path, number,
                       fmt::format("{} values; {}, one for each name of the first line, would be right",
                                   cells.size(), keys.size()));
    SweepPoint& point = points.emplace_back();
    for (std::size_t i = 0; i < keys.size(); ++i) point.emplace_back(keys[i], cells[i]);
  }
  if (points.empty())
    throw InputError(path, "has no points; a line of names and a line a point would be right");
  return points;
}

std::vector<SweptParameter> parameters_of(const std::vector<SweepPoint>& points) {
  std::vector<SweptParameter> parameters;
  for (const SweepPoint& point : points)
    for (const auto& [key, value] : point) {
      if (key == label_key) continue;
      auto known = std::find_if(parameters.begin(), parameters.end(),
                                [&key = key](const SweptParameter& each) { return each.key == key; });
      if (known == parameters.end()) known = parameters.insert(parameters.end(), {key, {}});
      if (std::find(known->values.begin(), known->values.end(), value) == known->values.end())
        known->values.push_back(value);
    }
  return parameters;
}

}  // namespace petzval::app
