// SPDX-License-Identifier: BSD-3-Clause
#include "loss_option.h"

#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/wavelength.h>
#include <petzval/base/whole_file.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>

namespace petzval::app {

namespace {

constexpr const char* table_form = "wavelength_nm,air_glass or wavelength_nm,surfaces[0],surfaces[3]…";

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) {
    const std::size_t first = cell.find_first_not_of(" \t\r"), last = cell.find_last_not_of(" \t\r");
    cells.push_back(first == std::string::npos ? "" : cell.substr(first, last - first + 1));
  }
  return cells;
}

/// Of "surfaces[3]".
std::optional<std::size_t> surface_of(const std::string& name) {
  constexpr std::string_view begin = "surfaces[";
  if (!name.starts_with(begin) || !name.ends_with("]")) return {};
  std::size_t surface = 0;
  const char* const last = name.data() + name.size() - 1;
  const auto [end, error] = std::from_chars(name.data() + begin.size(), last, surface);
  return error == std::errc() && end == last ? std::optional(surface) : std::nullopt;
}

/// The coating that a column of the table fills.
Coating& column(Losses& losses, const std::string& name, const std::string& file, int line) {
  if (name == "air_glass") return losses.air_glass ? *losses.air_glass : losses.air_glass.emplace();
  if (const std::optional<std::size_t> surface = surface_of(name)) return losses.surfaces[*surface];
  throw InputError(file, line, fmt::format("a column '{}'; the header must be {}", name, table_form));
}

void read_reflectances(const std::string& file, Losses& losses) {
  constexpr std::size_t most_bytes = std::size_t{64} << 20;
  std::istringstream in(read_whole_file(file, most_bytes));
  std::vector<std::string> header;
  std::string text;
  for (int line = 1; std::getline(in, text); ++line) {
    const std::vector<std::string> cells = cells_of(text);
    if (cells.empty() || cells[0].empty() || cells[0].front() == '#') continue;
    if (header.empty()) {
      if (cells.size() < 2 || cells[0] != "wavelength_nm")
        throw InputError(file, line,
                         fmt::format("no table of reflectances; its header must be {}", table_form));
      if (std::set<std::string>(cells.begin(), cells.end()).size() != cells.size())
        throw InputError(file, line, "a column stands twice in the header; once would be right");
      header = cells;
      continue;
    }
    if (cells.size() != header.size())
      throw InputError(file, line, fmt::format("{} values under {} columns", cells.size(), header.size()));
    for (std::size_t c = 1; c < header.size(); ++c) {
      const std::optional<double> wavelength = parse_number(cells[0]), reflectance = parse_number(cells[c]);
      if (!wavelength || !reflectance || *reflectance < 0 || *reflectance > 1)
        throw InputError(
            file, line,
            fmt::format("'{}' at '{}' nm; a reflectance from 0 to 1 would be right", cells[c], cells[0]));
      if (const std::string wrong = wavelength_fault(*wavelength); !wrong.empty())
        throw InputError(file, line, wrong);
      auto& table = column(losses, header[c], file, line).table;
      if (!table.empty() && !(*wavelength > table.back().first))
        throw InputError(file, line, "the wavelengths of a coating must increase");
      table.emplace_back(*wavelength, *reflectance);
    }
  }
  if (!losses.air_glass && losses.surfaces.empty())
    throw InputError(file,
                     fmt::format("holds no reflectances; {} and rows of numbers would be right", table_form));
}

/// A share, or films by name or file.
Coating read_one(const std::string& text) {
  const std::optional<double> reflectance = parse_number(text);
  return reflectance ? Coating::constant(*reflectance) : petzval::read_coating(text);
}

/// "mgf2,surfaces[3]=0.005": of all surfaces between air and glass, and of single ones.
void read_coatings(const std::string& text, Losses& losses) {
  for (const std::string& part : cells_of(text)) {
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos && !losses.air_glass) {
      losses.air_glass = read_one(part);
      continue;
    }
    const std::optional<std::size_t> surface = surface_of(part.substr(0, equals));
    if (equals == std::string::npos || !surface ||
        !losses.surfaces.emplace(*surface, read_one(part.substr(equals + 1))).second)
      throw InputError(
          fmt::format("'{}' is no coating of one surface; surfaces[3]=mgf2, each surface once, would be "
                      "right (--coating)",
                      part));
  }
}

}  // namespace

void LossChoice::add_to(CLI::App& command) {
  command.add_flag("--fresnel", fresnel, "Count reflection at bare glass surfaces (Fresnel)");
  command.add_option("--coating", coating,
                     "Coating of the surfaces between air and glass: a name or file of thin films (mgf2, "
                     "quarter-half-quarter, broadband-8, v-550), their reflectance as a number, or a CSV "
                     "file with columns wavelength_nm and air_glass or "
                     "surfaces[0], surfaces[3]…; of single surfaces: surfaces[0]=mgf2,surfaces[3]=0.005");
  command.add_flag("--absorption", absorption, "Count absorption in the glass, by the catalogue's k");
}

Losses LossChoice::read() const {
  Losses losses;
  losses.fresnel = fresnel;
  losses.absorption = absorption;
  if (coating.find("surfaces[") != std::string::npos)
    read_coatings(coating, losses);
  else if (coating.ends_with(".csv") || (std::filesystem::exists(coating) && !coating.ends_with(".json")))
    read_reflectances(coating, losses);
  else if (!coating.empty())
    losses.air_glass = read_one(coating);
  return losses;
}

Losses LossChoice::losses(const Lens& lens, const Shared& shared) const {
  const Losses losses = read();
  losses.validate(lens);
  if (absorption) {
    std::set<std::string> clear;
    for (const Surface& surface : lens.surfaces)
      if (!surface.material.extinction(lens.reference_wavelength_nm))
        clear.insert(surface.material.description());
    for (const std::string& name : clear)
      note(shared, fmt::format("no absorption data for {}: taken as perfectly clear", name));
  }
  return losses;
}

}  // namespace petzval::app
