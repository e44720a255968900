// SPDX-License-Identifier: BSD-3-Clause
// petzval lens list.
#include <fmt/format.h>
#include <petzval/base/data_directory.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_file.h>

#include "field_option.h"
#include "lens_commands.h"

namespace petzval::app {

namespace {

void list(const Shared& shared) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  // All lenses are read before anything is printed, so that an error leaves no half of an answer.
  std::string text =
      fmt::format("{:<20} {:>10} {:>8} {:>9}  {}\n", "name", "EFL [mm]", "f/", "FOV [deg]", "lens");
  for (const std::string& name : bundled_names("lenses", ".json")) {
    const Lens lens = read_lens(name).lens;
    const FirstOrder data = first_order(lens);
    if (!shared.json) {
      text += fmt::format("{:<20} {:>10.3f} {:>8} {:>9.1f}  {}\n", name, data.efl_mm,
                          has_f_number(data) ? fmt::format("{:.2f}", data.f_number) : "-",
                          data.field_of_view_deg, lens.name);
      continue;
    }
    rows.push_back({{"name", name},
                    {"description", lens.name},
                    {"source", lens.source},
                    {"efl_mm", number_or_null(data.efl_mm)},
                    {"f_number", f_number_or_null(data)},
                    {"field_of_view_deg", number_or_null(data.field_of_view_deg)}});
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
