// SPDX-License-Identifier: BSD-3-Clause
// petzval lens list.
#include <fmt/format.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/text_lines.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_file.h>
#include <petzval/lens/wavelength_range.h>
#include <petzval/simulate/lens_on_sensor.h>

#include <cctype>
#include <cmath>
#include <memory>

#include "field_option.h"
#include "lens_commands.h"

namespace petzval::app {

namespace {

/// What the indices of the glasses are known for; "any" where one index is given for all light.
std::string range_text(const LensWavelengths& light) {
  if (std::isinf(light.longest_nm)) return "any";
  return fmt::format("{:.0f}-{:.0f}", std::ceil(light.shortest_nm), std::floor(light.longest_nm));
}

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// Whether the name, what the lens is called or where it comes from has the word, in capitals or not.
bool mentions(const std::string& name, const Lens& lens, const std::string& word) {
  return lower(name + "\n" + lens.name + "\n" + lens.source).find(lower(word)) != std::string::npos;
}

void list(const std::string& word, const Shared& shared) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  // All lenses are read before anything is printed, so that an error leaves no half of an answer.
  std::string text = fmt::format("{:<23} {:>10} {:>6} {:>9} {:>12}  {}\n", "name", "EFL [mm]", "f/",
                                 "FOV [deg]", "light [nm]", "lens");
  std::size_t found = 0;
  const std::vector<std::string> all = all_bundled_names("lenses", ".json"),
                                 usual = bundled_names("lenses", ".json"),
                                 &names = word.empty() ? usual : all;
  for (const std::string& name : names) {
    const Lens lens = read_lens(name).lens;
    if (!mentions(name, lens, word)) continue;
    ++found;
    const FirstOrder data = first_order(lens);
    const LensWavelengths light = wavelength_range(lens);
    if (!shared.json) {
      const double n = is_afocal(data) ? data.working_f_number : data.f_number;
      text += fmt::format("{:<23} {:>10} {:>6} {:>9} {:>12}  {}\n", name,
                          is_afocal(data) ? "afocal" : fmt::format("{:.3f}", data.efl_mm),
                          is_afocal(data) || has_f_number(data) ? fmt::format("{:.2f}", n) : "-",
                          is_afocal(data) ? fmt::format("{:.2f}x", std::abs(data.magnification))
                                          : fmt::format("{:.1f}", data.field_of_view_deg),
                          range_text(light), lens.name);
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
  if (found == 0)
    throw InputError(
        fmt::format("no bundled lens has the word {}; machine vision, telecentric, C-mount, M12, "
                    "teaching, fisheye, patent or double Gauss would be right, or none for all",
                    quotable(word)));
  if (shared.json) return print_json({{"rows", rows}});
  fmt::print("{}", text);
  if (word.empty())
    fmt::print("\n{} more are from patents: petzval lens list patent\n", all.size() - usual.size());
}

}  // namespace

void add_lens_list(CLI::App& lens, Shared& shared) {
  auto word = std::make_shared<std::string>();
  CLI::App* command =
      add_command(lens, shared, "list", "The bundled lenses", "petzval lens list \"machine vision\"", true,
                  [=, &shared] { list(*word, shared); });
  command->add_option("word", *word,
                      "Only those whose name, description or source has it: C-mount, teaching, patent");
}

}  // namespace petzval::app
