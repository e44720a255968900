// SPDX-License-Identifier: BSD-3-Clause
// petzval lens list.
#include <fmt/format.h>
#include <petzval/base/data_directory.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_file.h>
#include <petzval/lens/wavelength_range.h>

#include <cmath>

#include "field_option.h"
#include "lens_commands.h"

namespace petzval::app {

namespace {

/// What the indices of the glasses are known for; "any" where one index is given for all light.
std::string range_text(const LensWavelengths& light) {
  if (std::isinf(light.longest_nm)) return "any";
  return fmt::format("{:.0f}-{:.0f}", std::ceil(light.shortest_nm), std::floor(light.longest_nm));
}

void list(const Shared& shared) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  // All lenses are read before anything is printed, so that an error leaves no half of an answer.
  std::string text = fmt::format("{:<23} {:>10} {:>6} {:>9} {:>12}  {}\n", "name", "EFL [mm]", "f/",
                                 "FOV [deg]", "light [nm]", "lens");
  for (const std::string& name : bundled_names("lenses", ".json")) {
    const Lens lens = read_lens(name).lens;
    const FirstOrder data = first_order(lens);
    const LensWavelengths light = wavelength_range(lens);
    if (!shared.json) {
      text += fmt::format("{:<23} {:>10.3f} {:>6} {:>9.1f} {:>12}  {}\n", name, data.efl_mm,
                          has_f_number(data) ? fmt::format("{:.2f}", data.f_number) : "-",
                          data.field_of_view_deg, range_text(light), lens.name);
      continue;
    }
    rows.push_back({{"name", name},
                    {"description", lens.name},
                    {"source", lens.source},
                    {"efl_mm", number_or_null(data.efl_mm)},
                    {"f_number", f_number_or_null(data)},
                    {"field_of_view_deg", number_or_null(data.field_of_view_deg)},
                    {"shortest_nm", light.shortest_nm},
                    {"longest_nm", number_or_null(light.longest_nm)}});
  }
  if (shared.json) return print_json({{"rows", rows}});
  fmt::print("{}", text);
}

}  // namespace

void add_lens_list(CLI::App& lens, Shared& shared) {
  add_command(lens, shared, "list", "The bundled lenses", "petzval lens list", true,
              [&shared] { list(shared); });
}

}  // namespace petzval::app
