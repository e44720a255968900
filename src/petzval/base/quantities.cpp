// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/quantities.h>
#include <petzval/base/text_lines.h>

#include <array>
#include <cmath>
#include <utility>

namespace petzval {

namespace {

/// Longer endings before those that they end in.
constexpr std::array<std::pair<std::string_view, double>, 5> units_a_metre{
    {{"mm", 1e3}, {"cm", 1e2}, {"um", 1e6}, {"km", 1e-3}, {"m", 1}}};

bool divides(double step, double start, double stop) {
  const double steps = (stop - start) / step;
  constexpr double rounding = 1e-9;
  return steps >= 0 && std::abs(steps - std::round(steps)) < rounding * std::max(1.0, steps);
}

void add_range(double start, double step, double stop, const std::string& said,
               std::vector<double>& numbers) {
  constexpr double most_numbers = 100'000;
  const double steps = (stop - start) / step;
  // A step beyond the stop is the other order of the three: 400:700:10.
  const bool oversteps = steps > 0 && steps < 1;
  if (!(steps >= 0 && steps < most_numbers) || oversteps) {
    const bool turned = step != 0 && stop != 0 && divides(stop, start, step);
    throw InputError(
        turned ? fmt::format("{} is no range; start:step:stop, as {:g}:{:g}:{:g}, would be right", said,
                             start, stop, step)
               : fmt::format("{} is no range; start:step:stop, as 400:10:700, would be right", said));
  }
  // The last step may miss the end by rounding.
  constexpr double share_of_a_step = 1e-9;
  for (int i = 0; i <= std::floor(steps + share_of_a_step); ++i) numbers.push_back(start + i * step);
}

}  // namespace

std::optional<double> parse_length_m(std::string_view text) {
  if (text == "infinity" || text == "inf") return INFINITY;
  for (const auto& [ending, in_a_metre] : units_a_metre) {
    if (!text.ends_with(ending)) continue;
    const std::optional<double> number = parse_number(trimmed(text.substr(0, text.size() - ending.size())));
    return number ? std::optional(*number / in_a_metre) : std::nullopt;
  }
  return {};
}

double parse_distance_m(std::string_view text, std::string_view parameter) {
  if (const std::optional<double> bare = parse_number(text))
    throw InputError(fmt::format("`{}` {}: a length needs its unit; {:g}m or {:g}mm would be right",
                                 parameter, text, *bare, *bare));
  const std::optional<double> metres = parse_length_m(text);
  if (!metres || !(*metres > 0))
    throw InputError(
        fmt::format("`{}` {}: a distance above 0 with its unit, as 1.2m or 250mm, would be right", parameter,
                    quotable(text)));
  return *metres;
}

std::string distance_text(double distance_m) {
  if (std::isinf(distance_m)) return "infinity";
  return distance_m < 1 ? fmt::format("{:.6g}mm", distance_m * 1e3) : fmt::format("{:.6g}m", distance_m);
}

std::vector<double> parse_number_list(std::string_view text, std::string_view parameter) {
  std::vector<double> numbers;
  for (const std::string& part : split_at(text, ',')) {
    const std::string said = fmt::format("`{}` {}: \"{}\"", parameter, quotable(text), quotable(part));
    std::vector<double> values;
    for (const std::string& word : split_at(part, ':')) {
      const std::optional<double> value = parse_number(trimmed(word));
      if (!value)
        throw InputError(fmt::format(
            "{} is no number and no range; start:step:stop, as 400:10:700, would be right", said));
      values.push_back(*value);
    }
    if (values.size() == 1)
      numbers.push_back(values[0]);
    else if (values.size() == 3)
      add_range(values[0], values[1], values[2], said, numbers);
    else
      throw InputError(fmt::format("{} is no range; start:step:stop, as 400:10:700, would be right", said));
  }
  return numbers;
}

GridSize parse_grid_size(std::string_view text, std::string_view parameter) {
  const std::vector<std::string> sides = split_at(text, 'x');
  const auto columns = sides.size() == 2 ? parse_integer(sides[0]) : std::nullopt;
  const auto rows = sides.size() == 2 ? parse_integer(sides[1]) : std::nullopt;
  if (!columns || !rows || *columns < 1 || *rows < 1)
    throw InputError(
        fmt::format("`{}` {}: columns x rows, as 768x576, would be right", parameter, quotable(text)));
  return {*columns, *rows};
}

}  // namespace petzval
