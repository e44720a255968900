// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/number_text.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>

namespace petzval {

namespace {

constexpr int double_digits = 17, extended_digits = 21;

template <typename Number>
std::optional<Number> parse(std::string_view word) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || word.empty()) return {};
  return value;
}

/// The double whose reciprocal is the curvature and whose text is shortest.
std::optional<std::string> short_radius(double curvature) {
  const double nearest = 1 / curvature;
  std::optional<std::string> best;
  for (const double radius : {nearest, std::nextafter(nearest, 0.0), std::nextafter(nearest, 2 * nearest)}) {
    if (1 / radius != curvature) continue;
    const std::string text = number_text(radius);
    if (!best || text.size() < best->size()) best = text;
  }
  return best;
}

}  // namespace

std::string number_text(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_not_of("-0123456789") == std::string::npos) text += ".0";
  return text;
}

std::string scaled_number_text(double value, int power_of_ten) {
  const std::string text = number_text(value * std::pow(10.0, power_of_ten));
  if (parse_scaled_number(text, -power_of_ten) == value) return text;
  const std::string digits = fmt::format("{}", value);
  const std::size_t mark = std::min(digits.find('e'), digits.size());
  const int exponent = mark < digits.size() ? std::atoi(digits.c_str() + mark + 1) : 0;
  return fmt::format("{}e{}", digits.substr(0, mark), exponent + power_of_ten);
}

std::optional<double> parse_number(std::string_view word) {
  const auto value = parse<double>(word);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<double> parse_scaled_number(std::string_view word, int power_of_ten) {
  const std::size_t mark = std::min(word.find_first_of("eE"), word.size());
  const auto exponent = mark == word.size() ? std::optional(0) : parse<int>(word.substr(mark + 1));
  constexpr int farthest = 1000;  // beyond the range of a double, within that of a sum of ints
  if (!exponent || std::abs(*exponent) > farthest) return {};
  return parse_number(fmt::format("{}e{}", word.substr(0, mark), *exponent + power_of_ten));
}

std::optional<int> parse_integer(std::string_view word) {
  return parse<int>(word);
}

bool is_beyond_double(std::string_view number) {
  number = number.substr(0, number.find_first_of("eE"));
  const std::size_t first = std::min(number.find_first_of("123456789"), number.size());
  return std::count_if(number.begin() + static_cast<std::ptrdiff_t>(first), number.end(),
                       [](unsigned char c) { return std::isdigit(c); }) > double_digits;
}

std::string radius_text(double curvature_per_mm) {
  if (const auto text = short_radius(curvature_per_mm)) return *text;
  for (int digits = double_digits + 1; digits < extended_digits; ++digits) {
    const std::string text = fmt::format("{:#.{}g}", 1.0L / curvature_per_mm, digits);
    if (curvature_from_radius(text) == curvature_per_mm) return text;
  }
  return fmt::format("{:#.{}g}", 1.0L / curvature_per_mm, extended_digits);
}

double curvature_from_radius(std::string_view radius) {
  if (!is_beyond_double(radius)) return 1 / parse<double>(radius).value_or(NAN);
  return static_cast<double>(1 / parse<long double>(radius).value_or(NAN));
}

}  // namespace petzval
