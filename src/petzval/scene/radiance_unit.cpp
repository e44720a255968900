// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/text_lines.h>
#include <petzval/scene/radiance_unit.h>

#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace petzval {

namespace {

/// Powers of ten, watts, metres and steradians of a product of units.
struct Dimensions {
  int ten = 0, watt = 0, metre = 0, steradian = 0;

  void add(const Dimensions& other, int times) {
    ten += times * other.ten, watt += times * other.watt;
    metre += times * other.metre, steradian += times * other.steradian;
  }
};

/// Superscripts, dots and micro signs as ASCII.
std::string plain(std::string_view unit) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 17> spellings{{
      {"⁻", "-"},
      {"⁰", "0"},
      {"¹", "1"},
      {"²", "2"},
      {"³", "3"},
      {"·", "."},
      {"⋅", "."},
      {"×", "."},
      {"µ", "u"},
      {"μ", "u"},
      {"−", "-"},
      {"**", "^"},
      {"*", "."},
      {"{", ""},
      {"}", ""},
      {"[", ""},
      {"]", ""},
  }};
  std::string text;
  while (!unit.empty()) {
    bool replaced = false;
    for (const auto& [from, to] : spellings)
      if (unit.starts_with(from)) {
        text += to;
        unit.remove_prefix(from.size());
        replaced = true;
        break;
      }
    if (replaced) continue;
    text += unit.front();
    unit.remove_prefix(1);
  }
  return text;
}

/// A unit without prefix, or nothing.
std::optional<Dimensions> base_unit(std::string_view word) {
  static constexpr std::array<std::pair<std::string_view, Dimensions>, 13> units{{
      {"W", {0, 1, 0, 0}},
      {"Watt", {0, 1, 0, 0}},
      {"watt", {0, 1, 0, 0}},
      {"Watts", {0, 1, 0, 0}},
      {"watts", {0, 1, 0, 0}},
      {"m", {0, 0, 1, 0}},
      {"meter", {0, 0, 1, 0}},
      {"metre", {0, 0, 1, 0}},
      {"sr", {0, 0, 0, 1}},
      {"steradian", {0, 0, 0, 1}},
      {"ster", {0, 0, 0, 1}},
      {"micron", {-6, 0, 1, 0}},
      {"microns", {-6, 0, 1, 0}},
  }};
  for (const auto& [name, dimensions] : units)
    if (word == name) return dimensions;
  return std::nullopt;
}

std::optional<Dimensions> unit_of(std::string_view word) {
  static constexpr std::array<std::pair<std::string_view, int>, 10> prefixes{{{"", 0},
                                                                              {"nano", -9},
                                                                              {"micro", -6},
                                                                              {"milli", -3},
                                                                              {"n", -9},
                                                                              {"u", -6},
                                                                              {"m", -3},
                                                                              {"c", -2},
                                                                              {"k", 3},
                                                                              {"M", 6}}};
  for (const auto& [prefix, ten] : prefixes) {
    if (!word.starts_with(prefix)) continue;
    if (std::optional<Dimensions> unit = base_unit(word.substr(prefix.size()))) {
      unit->ten += ten;
      return unit;
    }
  }
  return std::nullopt;
}

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

/// Reads words with exponents, what stands under a stroke negative.
class UnitParser {
 public:
  explicit UnitParser(std::string_view text) : rest_(text) {}

  /// Nothing if it is no product of units.
  std::optional<Dimensions> parse() {
    while (!rest_.empty()) {
      const char c = rest_.front();
      if (c == ' ' || c == '.') {
        rest_.remove_prefix(1);
      } else if (c == '/') {
        stroke_ = true;
        rest_.remove_prefix(1);
      } else if (c == '(' || c == ')') {
        // "W/(m2 sr nm)": all of the bracket is under the stroke.
        if (c == '(') bracket_under_stroke_ = stroke_;
        if (c == ')') bracket_under_stroke_ = false;
        stroke_ = false;
        rest_.remove_prefix(1);
      } else if (!take_unit()) {
        return std::nullopt;
      }
    }
    return sum_;
  }

 private:
  bool take_unit() {
    std::size_t letters = 0;
    while (letters < rest_.size() && is_letter(rest_[letters])) ++letters;
    const std::optional<Dimensions> unit = unit_of(rest_.substr(0, letters));
    if (!unit) return false;
    rest_.remove_prefix(letters);
    const int exponent = take_exponent();
    sum_.add(*unit, stroke_ || bracket_under_stroke_ ? -exponent : exponent);
    stroke_ = false;
    return std::abs(exponent) <= 3;
  }

  /// "^-2", "-2", "2", or none: 1.
  int take_exponent() {
    if (rest_.starts_with('^')) rest_.remove_prefix(1);
    const bool bracketed = rest_.starts_with('(');
    if (bracketed) rest_.remove_prefix(1);
    const bool negative = rest_.starts_with('-');
    if (negative) rest_.remove_prefix(1);
    int value = 1;
    if (!rest_.empty() && rest_.front() >= '0' && rest_.front() <= '9') {
      value = rest_.front() - '0';
      rest_.remove_prefix(1);
    }
    if (bracketed && rest_.starts_with(')')) rest_.remove_prefix(1);
    return negative ? -value : value;
  }

  std::string_view rest_;
  bool stroke_ = false, bracket_under_stroke_ = false;
  Dimensions sum_;
};

constexpr int nm_per_m_power = 9;

}  // namespace

double radiance_scale(std::string_view unit) {
  const std::string text = plain(unit);
  const std::optional<Dimensions> d = UnitParser(text).parse();
  const auto is = [&](int watt, int metre, int steradian) {
    return d && d->watt == watt && d->metre == metre && d->steradian == steradian;
  };
  if (is(1, -3, -1)) return std::pow(10.0, d->ten - nm_per_m_power);
  if (is(1, -2, -1)) return std::pow(10.0, d->ten);
  const char* const what = is(1, -3, 0) || is(1, -2, 0) ? " (irradiance)" : "";
  throw InputError(fmt::format("values in {}{}; a scene is radiance, in W.m^-2.sr^-1.nm^-1 or the like",
                               quotable(unit), what));
}

}  // namespace petzval
