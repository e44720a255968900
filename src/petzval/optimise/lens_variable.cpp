// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/optimise/lens_variable.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace petzval {

namespace {

using Kind = LensNumber::Kind;

struct Limits {
  double low, high;
};

[[noreturn]] void refuse_variable(std::string_view text) {
  throw InputError(fmt::format(
      "variable {}: radii, thicknesses, gaps, image, or one number such as surfaces[3].radius_mm, "
      "surfaces[4].thickness_mm=0.5:8, surfaces[1].conic or surfaces[1].asphere.4 would be right",
      quotable(text)));
}

std::optional<Limits> parse_limits(std::string_view whole, std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == text.npos) refuse_variable(whole);
  const auto low = parse_number(text.substr(0, colon)), high = parse_number(text.substr(colon + 1));
  if (!low || !high || !(*low < *high) || !std::isfinite(*low) || !std::isfinite(*high))
    throw InputError(
        fmt::format("variable {}: limits LOW:HIGH with LOW below HIGH would be right", quotable(whole)));
  return Limits{*low, *high};
}

LensVariable limited(std::string_view whole, const LensNumber& number, const std::optional<Limits>& limits) {
  LensVariable variable{number};
  if (!limits) return variable;
  if (number.kind != Kind::curvature_per_mm) return {number, limits->low, limits->high};
  if (limits->low <= 0 && limits->high >= 0)
    throw InputError(
        fmt::format("variable {}: a radius between {:g} and {:g} mm may be nothing; limits of one "
                    "sign would be right",
                    quotable(whole), limits->low, limits->high));
  return {number, 1 / limits->high, 1 / limits->low};
}

std::optional<std::size_t> whole_number(std::string_view text) {
  const auto number = parse_integer(std::string(text));
  if (!number || *number < 0) return {};
  return static_cast<std::size_t>(*number);
}

/// "surfaces[3].asphere.4"
std::optional<LensNumber> parse_one(std::string_view text) {
  constexpr std::string_view begins = "surfaces[";
  const std::size_t end = text.find(']');
  if (!text.starts_with(begins) || end == text.npos) return {};
  const auto surface = whole_number(text.substr(begins.size(), end - begins.size()));
  if (!surface) return {};
  const std::string_view key = text.substr(end + 1);
  if (key == ".radius_mm") return LensNumber{Kind::curvature_per_mm, *surface};
  if (key == ".thickness_mm") return LensNumber{Kind::thickness_mm, *surface};
  if (key == ".conic") return LensNumber{Kind::conic, *surface};
  constexpr std::string_view powers = ".asphere.";
  const auto power = key.starts_with(powers) ? whole_number(key.substr(powers.size())) : std::nullopt;
  if (!power || *power > 30) return {};
  return LensNumber{Kind::power, *surface, static_cast<int>(*power)};
}

/// Least gap of air that `gaps` leaves [mm].
constexpr double least_gap_mm = 0.05;

std::vector<LensVariable> thicknesses(const Lens& lens, bool of_glass, std::string_view whole,
                                      const std::optional<Limits>& limits) {
  std::vector<LensVariable> variables;
  for (std::size_t i = 0; i + 1 < lens.surfaces.size(); ++i) {
    const double now = lens.surfaces[i].thickness_mm;
    if (lens.surfaces[i].material.is_air() == of_glass || !(now > 0)) continue;
    const Limits usual = of_glass ? Limits{now / 2, now * 2}
                                  : Limits{std::min(now, std::max(now / 10, least_gap_mm)), now * 3};
    variables.push_back(limited(whole, {Kind::thickness_mm, i}, limits ? limits : usual));
  }
  return variables;
}

}  // namespace

std::vector<LensVariable> parse_lens_variables(const Lens& lens, std::string_view text) {
  const std::size_t equals = text.find('=');
  const std::string_view key = text.substr(0, equals);
  std::optional<Limits> limits;
  if (equals != text.npos) limits = parse_limits(text, text.substr(equals + 1));
  std::vector<LensVariable> variables;
  if (key == "radii") {
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i)
      if (lens.surfaces[i].curvature_per_mm != 0)
        variables.push_back(limited(text, {Kind::curvature_per_mm, i}, limits));
  } else if (key == "thicknesses" || key == "gaps") {
    variables = thicknesses(lens, key == "thicknesses", text, limits);
  } else if (key == "image") {
    variables = {limited(text, {Kind::thickness_mm, lens.surfaces.size() - 1}, limits)};
  } else if (const auto one = parse_one(key)) {
    value_of(lens, *one);  // refuses what the lens does not have
    variables = {limited(text, *one, limits)};
  } else {
    refuse_variable(text);
  }
  for (const LensVariable& variable : variables) {
    const double now = value_of(lens, variable.number);
    if (!(now >= variable.low && now <= variable.high))
      throw InputError(
          fmt::format("variable {}: {} is {:g} and lies outside of its limits; wider limits would "
                      "be right",
                      quotable(text), name_of(variable.number), shown_value(lens, variable.number)));
  }
  if (variables.empty()) throw InputError(fmt::format("variable {}: the lens has none", quotable(text)));
  return variables;
}

std::string name_of(const LensNumber& number) {
  const std::string surface = fmt::format("surfaces[{}].", number.surface);
  switch (number.kind) {
    case Kind::curvature_per_mm:
      return surface + "radius_mm";
    case Kind::thickness_mm:
      return surface + "thickness_mm";
    case Kind::conic:
      return surface + "conic";
    case Kind::power:
      break;
  }
  return surface + fmt::format("asphere.{}", number.power);
}

double shown_value(const Lens& lens, const LensNumber& number) {
  const double value = value_of(lens, number);
  return number.kind == Kind::curvature_per_mm ? 1 / value : value;
}

}  // namespace petzval
