// SPDX-License-Identifier: BSD-3-Clause
#include "sweep_points.h"

#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>

#include <cctype>
#include <cmath>
#include <optional>
#include <set>

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

/// Options whose own values may be start:step:stop: a range is one value of theirs.
bool takes_lists(const std::string& key) {
  return key == "wavelengths" || key == "scene-bands" || key == "fields" || key == "field";
}

struct Range {
  double from = 0, step = 0, to = 0;
  std::string unit;  ///< of all three; may be empty

  /// How many values it has; nothing if the step does not lead from one end to the other.
  std::optional<double> count() const {
    if (step == 0 || (to - from) / step < 0) return {};
    constexpr double rounding = 1e-9;
    return std::floor((to - from) / step + rounding) + 1;
  }
  /// Twelve digits: 0.1 three times is 0.3.
  std::string value(double number) const { return fmt::format("{:.12g}{}", number, unit); }
};

/// A number and the letters behind it.
struct Quantity {
  double value;
  std::string unit;
};

std::optional<Quantity> quantity_of(const std::string& text) {
  std::size_t end = text.size();
  while (end > 0 && std::isalpha(static_cast<unsigned char>(text[end - 1]))) --end;
  const auto number = parse_number(text.substr(0, end));
  if (!number) return {};
  return Quantity{*number, text.substr(end)};
}

/// START:STEP:STOP, or START:STOP for so many frames, if the text is numbers with colons between them.
/// \throws InputError if one is none.
std::optional<Range> parse_range(const std::string& key, const std::string& text, std::optional<int> frames) {
  if (text.find(',') != text.npos) return {};
  const std::vector<std::string> parts = split(text, ':');
  std::vector<Quantity> numbers;
  for (const std::string& part : parts)
    if (const auto quantity = quantity_of(part)) numbers.push_back(*quantity);
  if (parts.size() == 2 && numbers.size() == 2 && !frames)
    throw InputError(
        fmt::format("--vary {}={}: a step, as in START:STEP:STOP, or --frames would be right", key, text));
  if ((parts.size() != 3 && parts.size() != 2) || numbers.empty()) return {};
  if (numbers.size() != parts.size() || numbers.front().unit != numbers.back().unit ||
      numbers[1].unit != numbers.back().unit)
    throw InputError(fmt::format(
        "--vary {}={}: START:STEP:STOP are three numbers of one unit, as in 0.4:0.05:0.6 or 1m:0.1m:2m", key,
        text));
  const std::string unit = numbers.front().unit;
  if (numbers.size() == 3) return Range{numbers[0].value, numbers[1].value, numbers[2].value, unit};
  const double way = numbers[1].value - numbers[0].value;
  return Range{numbers[0].value, way / (*frames - 1), numbers[1].value, unit};
}

std::vector<std::string> values_of(const std::string& key, const Range& range, const std::string& text) {
  const std::optional<double> count = range.count();
  // One value of a range that has two ends is the other order of the three: 0.4:0.6:0.05.
  if (!count || (*count < 2 && range.from != range.to)) {
    const Range turned{range.from, range.to, range.step, range.unit};
    const std::string right =
        range.step == 0 ? std::string("a step other than 0")
        : turned.count().value_or(0) >= 2
            ? fmt::format("{0}{3}:{1}{3}:{2}{3}", turned.from, turned.step, turned.to, range.unit)
            : fmt::format("{0}{3}:{1}{3}:{2}{3}", range.from, -range.step, range.to, range.unit);
    throw InputError(fmt::format("--vary {}={}: steps of {} do not lead from {} to {}; {} would be right",
                                 key, text, range.step, range.from, range.to, right));
  }
  if (*count > most_points)
    throw InputError(
        fmt::format("--vary {}={}: {} values; at most {} are right", key, text, *count, most_points));
  std::vector<std::string> values;
  for (int i = 0; i < static_cast<int>(*count); ++i)
    values.push_back(range.value(range.from + i * range.step));
  return values;
}

/// The same text for numbers that are the same.
std::string canonical(const std::string& value) {
  const auto number = parse_number(value);
  return number ? fmt::format("{:.17g}", *number) : value;
}

/// Each value once, the first of those that are the same.
std::vector<std::string> without_duplicates(const SweptParameter& parameter,
                                            std::vector<std::string>& notes) {
  std::vector<std::string> once;
  std::set<std::string> known;
  for (const std::string& value : parameter.values)
    if (known.insert(canonical(value)).second)
      once.push_back(value);
    else
      notes.push_back(fmt::format("--vary {}: {} stands there twice and is made once", parameter.key, value));
  return once;
}

}  // namespace

SweptParameter parse_swept(const std::string& text, std::vector<std::string>& notes,
                           std::optional<int> frames) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    throw InputError(
        fmt::format("--vary {}: KEY=START:STEP:STOP or KEY=A,B,… would be right, as in "
                    "surfaces[4].thickness_mm=0.4:0.05:0.6",
                    text));
  SweptParameter parameter{text.substr(0, equals), {}};
  const std::string values = text.substr(equals + 1);
  const std::optional<Range> range =
      takes_lists(parameter.key) ? std::nullopt : parse_range(parameter.key, values, frames);
  if (!range) {
    parameter.values = split(values, ',');
  } else {
    parameter.values = values_of(parameter.key, *range, values);
    if (parameter.values.back() != range->value(range->to))
      notes.push_back(fmt::format("--vary {}: the last value is {}; steps of {:g} do not meet {:g}", text,
                                  parameter.values.back(), range->step, range->to));
  }
  for (const std::string& value : parameter.values)
    if (value.empty()) throw InputError(fmt::format("--vary {}: a value is empty", text));
  if (parameter.values.size() > most_points)
    throw InputError(fmt::format("--vary {}: more than {} values", parameter.key, most_points));
  parameter.values = without_duplicates(parameter, notes);
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
