// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/text_lines.h>
#include <petzval/base/units.h>
#include <petzval/optimise/build_number.h>

#include <cmath>

namespace petzval {

namespace {

constexpr std::string_view sensor_tilt = "sensor_tilt_deg";

[[noreturn]] void refuse_number(std::string_view text) {
  throw InputError(fmt::format(
      "free {}: defocus_mm, sensor_tilt_deg, element_decentre_mm@2-3, element_tilt_deg@2-3, another kind of "
      "`lens tolerance` or sag4_um@0, with =LIMIT if it is known, would be right",
      quotable(text)));
}

/// "sag4_um@0": its power; 0 for another text.
int power_of(std::string_view key) {
  for (const int power : {4, 6, 8})
    if (key.starts_with(fmt::format("sag{}_um@", power))) return power;
  return 0;
}

BuildNumber sag_number(const Lens& lens, std::string_view text, std::string_view key, int power) {
  const auto surface = parse_integer(std::string(key.substr(key.find('@') + 1)));
  if (!surface || *surface < 0 || static_cast<std::size_t>(*surface) >= lens.surfaces.size())
    throw InputError(fmt::format("free {}: a surface from 0 to {} would be right", quotable(text),
                                 lens.surfaces.size() - 1));
  const auto index = static_cast<std::size_t>(*surface);
  const Surface& at = lens.surfaces[index];
  if (at.shape || at.transfer || !at.semi_diameter_mm)
    throw InputError(fmt::format(
        "free {}: a surface of powers of r with a clear aperture, semi_diameter_mm, would be right",
        quotable(text)));
  BuildNumber number;
  number.kind = BuildNumber::Kind::sag_um;
  number.tolerance.first = number.tolerance.last = index;
  number.power = power;
  return number;
}

std::vector<BuildNumber> tolerance_numbers(const Lens& lens, std::string_view text, std::string_view key) {
  BuildNumber number;
  number.kind = BuildNumber::Kind::tolerance;
  if (key == sensor_tilt)
    number.tolerance = {std::string(sensor_tilt), 0, 0, 1};
  else if (key.find('@') == key.npos)
    refuse_number(text);
  else
    number.tolerance = parse_tolerance(fmt::format("{}=1", key));
  check(lens, number.tolerance);
  if (!find_tolerance_kind(number.tolerance.kind)->has_direction) return {number};
  BuildNumber other = number;
  number.axis = 'x', other.axis = 'y';
  return {number, other};
}

}  // namespace

std::string BuildNumber::name() const {
  std::string name;
  switch (kind) {
    case Kind::defocus_mm:
      return map ? fmt::format("defocus_mm, photograph {}", *map + 1) : "defocus_mm";
    case Kind::sag_um:
      return fmt::format("sag{}_um@{}", power, tolerance.first);
    case Kind::tolerance:
      name = tolerance.kind == sensor_tilt ? tolerance.kind : place_of(tolerance);
  }
  return axis == ' ' ? name : fmt::format("{} {}", name, axis);
}

std::string BuildNumber::unit() const {
  switch (kind) {
    case Kind::defocus_mm:
      return "mm";
    case Kind::sag_um:
      return "um";
    case Kind::tolerance:
      break;
  }
  return find_tolerance_kind(tolerance.kind)->unit;
}

double BuildNumber::scale() const {
  const std::string unit = this->unit();
  if (unit == "mm") return 0.01;
  if (unit == "deg") return 0.05;
  if (unit == "fringes") return 1;
  if (unit == "%" || unit == "um") return 0.1;
  return 1e-3;  // of an index
}

std::vector<BuildNumber> parse_build_numbers(const Lens& lens, std::string_view text) {
  const std::size_t equals = text.find('=');
  const std::string_view key = text.substr(0, equals);
  std::vector<BuildNumber> numbers;
  if (key == "defocus_mm")
    numbers = {BuildNumber{}};
  else if (const int power = power_of(key))
    numbers = {sag_number(lens, text, key, power)};
  else
    numbers = tolerance_numbers(lens, text, key);
  if (equals == text.npos) return numbers;
  const auto limit = parse_number(std::string(text.substr(equals + 1)));
  if (!limit || !(*limit > 0) || !std::isfinite(*limit))
    throw InputError(fmt::format("free {}: a limit of a positive number would be right", quotable(text)));
  for (BuildNumber& number : numbers) number.deviation = *limit / 2;
  return numbers;
}

Lens with_number(Lens lens, const BuildNumber& number, double value) {
  if (value == 0) return lens;
  switch (number.kind) {
    case BuildNumber::Kind::defocus_mm:
      lens.set_image_distance_mm(lens.image_distance_mm() + value);
      return lens;
    case BuildNumber::Kind::sag_um: {
      Surface& surface = lens.surfaces[number.tolerance.first];
      surface.asphere[number.power] += value * mm_per_um / std::pow(*surface.semi_diameter_mm, number.power);
      return lens;
    }
    case BuildNumber::Kind::tolerance:
      break;
  }
  const bool along_y = number.axis == 'y';
  return with_error(std::move(lens), number.tolerance, along_y ? 0 : value, along_y ? value : 0);
}

}  // namespace petzval
