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
      "variable {}: radii, thicknesses, gaps, image, poses, or one number such as surfaces[3].radius_mm, "
      "surfaces[4].thickness_mm=0.5:8, surfaces[1].asphere.4 or groups[0].pose.tilt_x_deg would be right",
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

/// What follows "surfaces[3]" or "groups[3]", and the number there.
struct IndexedKey {
  std::size_t index;
  std::string_view key;
};

std::optional<IndexedKey> parse_index(std::string_view list, std::string_view text) {
  const std::size_t end = text.find(']');
  if (!text.starts_with(list) || end == text.npos) return {};
  const auto index = whole_number(text.substr(list.size(), end - list.size()));
  if (!index) return {};
  return IndexedKey{*index, text.substr(end + 1)};
}

/// "tilt_x_deg"
std::optional<LensNumber> parse_pose(Kind kind, std::size_t of, std::string_view name) {
  for (std::size_t i = 0; i < pose_numbers.size(); ++i)
    if (name == pose_numbers[i].name) return LensNumber{kind, of, static_cast<int>(i)};
  return {};
}

/// "surfaces[3].asphere.4"
std::optional<LensNumber> parse_one(std::string_view text) {
  constexpr std::string_view sensor = "sensor_pose.", pose = ".pose.", powers = ".asphere.";
  if (text.starts_with(sensor)) return parse_pose(Kind::sensor_pose, 0, text.substr(sensor.size()));
  if (const auto group = parse_index("groups[", text))
    return group->key.starts_with(pose)
               ? parse_pose(Kind::group_pose, group->index, group->key.substr(pose.size()))
               : std::nullopt;
  const auto surface = parse_index("surfaces[", text);
  if (!surface) return {};
  const auto& [index, key] = *surface;
  if (key == ".radius_mm") return LensNumber{Kind::curvature_per_mm, index};
  if (key == ".thickness_mm") return LensNumber{Kind::thickness_mm, index};
  if (key == ".conic") return LensNumber{Kind::conic, index};
  if (key.starts_with(pose)) return parse_pose(Kind::surface_pose, index, key.substr(pose.size()));
  const auto power = key.starts_with(powers) ? whole_number(key.substr(powers.size())) : std::nullopt;
  if (!power || *power > 30) return {};
  return LensNumber{Kind::power, index, static_cast<int>(*power)};
}

void add_set_numbers(const Pose& pose, Kind kind, std::size_t of, std::vector<LensVariable>& variables) {
  for (std::size_t i = 0; i < pose_numbers.size(); ++i)
    if (pose.*pose_numbers[i].value != 0) variables.push_back({{kind, of, static_cast<int>(i)}});
}

std::vector<LensVariable> set_poses(const Lens& lens, std::string_view whole,
                                    const std::optional<Limits>& limits) {
  if (limits)
    throw InputError(
        fmt::format("variable {}: poses are lengths and angles, and have no limits in common; "
                    "poses, or one number with limits, would be right",
                    quotable(whole)));
  std::vector<LensVariable> variables;
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i)
    add_set_numbers(lens.surfaces[i].pose, Kind::surface_pose, i, variables);
  for (std::size_t i = 0; i < lens.groups.size(); ++i)
    add_set_numbers(lens.groups[i].pose, Kind::group_pose, i, variables);
  add_set_numbers(lens.sensor_pose, Kind::sensor_pose, 0, variables);
  return variables;
}

/// Of a thickness, whose limits are stated along the light.
LensVariable along_light(const Lens& lens, std::size_t surface, std::string_view whole,
                         std::optional<Limits> limits) {
  if (limits && lens.sense_behind(surface) < 0) limits = {-limits->high, -limits->low};
  return limited(whole, {Kind::thickness_mm, surface}, limits);
}

/// Least gap of air that `gaps` leaves [mm].
constexpr double least_gap_mm = 0.05;

std::vector<LensVariable> thicknesses(const Lens& lens, bool of_glass, std::string_view whole,
                                      const std::optional<Limits>& limits) {
  std::vector<LensVariable> variables;
  for (std::size_t i = 0; i + 1 < lens.surfaces.size(); ++i) {
    const double now = lens.sense_behind(i) * lens.surfaces[i].thickness_mm;
    if (lens.medium_behind(i).is_air() == of_glass || !(now > 0)) continue;
    const Limits usual = of_glass ? Limits{now / 2, now * 2}
                                  : Limits{std::min(now, std::max(now / 10, least_gap_mm)), now * 3};
    variables.push_back(along_light(lens, i, whole, limits ? limits : usual));
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
    variables = {along_light(lens, lens.surfaces.size() - 1, text, limits)};
  } else if (key == "poses") {
    variables = set_poses(lens, text, limits);
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
  const auto pose_name = [&] { return pose_numbers[static_cast<std::size_t>(number.power)].name; };
  switch (number.kind) {
    case Kind::curvature_per_mm:
      return surface + "radius_mm";
    case Kind::thickness_mm:
      return surface + "thickness_mm";
    case Kind::conic:
      return surface + "conic";
    case Kind::power:
      break;
    case Kind::surface_pose:
      return fmt::format("{}pose.{}", surface, pose_name());
    case Kind::group_pose:
      return fmt::format("groups[{}].pose.{}", number.surface, pose_name());
    case Kind::sensor_pose:
      return fmt::format("sensor_pose.{}", pose_name());
  }
  return surface + fmt::format("asphere.{}", number.power);
}

double shown_value(const Lens& lens, const LensNumber& number) {
  const double value = value_of(lens, number);
  return number.kind == Kind::curvature_per_mm ? 1 / value : value;
}

}  // namespace petzval
