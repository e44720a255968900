// SPDX-License-Identifier: BSD-3-Clause
#include "sweep_points.h"

#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>

#include <cmath>
#include <optional>

namespace petzval::app {

namespace {

constexpr double most_points = 10000;

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t from = 0;
  for (std::size_t at; (at = text.find(separator, from)) != std::string::npos; from = at + 1)
    parts.push_back(text.substr(from, at - from));
  parts.push_back(text.substr(from));
  return parts;
}

/// FROM:TO:STEP, both ends included; nothing if the text is no such range.
std::optional<std::vector<std::string>> range(const std::string& text) {
  const std::vector<std::string> parts = split(text, ':');
  if (parts.size() != 3) return {};
  const auto from = parse_number(parts[0]), to = parse_number(parts[1]), step = parse_number(parts[2]);
  if (!from || !to || !step || *step == 0 || (*to - *from) / *step < 0) return {};
  constexpr double rounding = 1e-9;
  const double count = std::floor((*to - *from) / *step + rounding) + 1;
  if (count > most_points)
    throw InputError(fmt::format("--vary {}: {} values; at most {} are right", text, count, most_points));
  std::vector<std::string> values;
  // Twelve digits: 0.1 three times is 0.3.
  for (int i = 0; i < static_cast<int>(count); ++i)
    values.push_back(fmt::format("{:.12g}", *from + i * *step));
  return values;
}

}  // namespace

SweptParameter parse_swept(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    throw InputError(
        fmt::format("--vary {}: KEY=FROM:TO:STEP or KEY=A,B,… would be right, as in "
                    "surfaces[4].thickness_mm=0.4:0.6:0.05",
                    text));
  SweptParameter parameter{text.substr(0, equals), {}};
  const std::string values = text.substr(equals + 1);
  parameter.values = range(values).value_or(split(values, ','));
  for (const std::string& value : parameter.values)
    if (value.empty()) throw InputError(fmt::format("--vary {}: a value is empty", text));
  return parameter;
}

std::vector<SweepPoint> sweep_points(const std::vector<SweptParameter>& parameters) {
  std::vector<SweepPoint> points{{}};
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      if (parameters[j].key == parameters[i].key)
        throw InputError(
            fmt::format("--vary {}: given twice; one list of values is right", parameters[i].key));
    if (double(points.size()) * double(parameters[i].values.size()) > most_points)
      throw InputError(fmt::format("the sweep has more than {} points", most_points));
    std::vector<SweepPoint> more;
    for (const SweepPoint& point : points)
      for (const std::string& value : parameters[i].values) {
        more.push_back(point);
        more.back().emplace_back(parameters[i].key, value);
      }
    points = std::move(more);
  }
  return points;
}

}  // namespace petzval::app
