// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/whole_file.h>
#include <petzval/focus/zones.h>

#include <array>
#include <cmath>
#include <sstream>

namespace petzval {

namespace {

/// Far more than anybody aims with.
constexpr std::size_t most_zones = 1000;

FocusZone zone_of(const std::string& line, const std::string& file, int number) {
  std::istringstream words(line);
  std::array<double, 4> v{};
  for (double& value : v)
    if (!(words >> value))
      throw InputError(file, number, "a zone is four numbers: left right top bottom, from 0 to 1");
  std::string rest;
  if (words >> rest) throw InputError(file, number, "a zone is four numbers, and nothing after them");
  const FocusZone zone{v[0], v[1], v[2], v[3]};
  if (!(zone.left >= 0 && zone.left < zone.right && zone.right <= 1 && zone.top >= 0 &&
        zone.top < zone.bottom && zone.bottom <= 1))
    throw InputError(
        file, number,
        fmt::format("the zone {:g} {:g} {:g} {:g} is no part of the film; 0 <= left < right <= 1 and 0 <= "
                    "top < bottom <= 1 would be right",
                    v[0], v[1], v[2], v[3]));
  return zone;
}

}  // namespace

std::vector<FocusZone> parse_focus_zones(std::string_view text, const std::string& file) {
  std::vector<FocusZone> zones;
  std::istringstream lines{std::string(text)};
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    line = line.substr(0, line.find('#'));
    if (line.find_first_not_of(" \t\r,") == std::string::npos) continue;
    for (char& c : line)
      if (c == ',') c = ' ';
    zones.push_back(zone_of(line, file, number));
    if (zones.size() > most_zones)
      throw InputError(file, number, fmt::format("more than {} zones", most_zones));
  }
  if (zones.empty()) throw InputError(file, "holds no zone; a line of left right top bottom would be one");
  return zones;
}

std::vector<FocusZone> read_focus_zones(const std::string& path) {
  return parse_focus_zones(read_whole_file(path, std::size_t{1} << 20), path);
}

}  // namespace petzval
