// SPDX-License-Identifier: BSD-3-Clause
// petzval glass list | show | find
#include "command.h"
#include "field_option.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/glass/catalogue.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

namespace petzval::app {

namespace {

using json = nlohmann::ordered_json;
using GlassPointer = std::shared_ptr<const Glass>;

/// Every glass, or those of one catalogue; case does not matter. \throws InputError if there is none such.
std::vector<GlassPointer> glasses_of(const GlassCatalogue& all, const std::string& catalogue) {
  std::vector<GlassPointer> glasses;
  for (const std::string& name : all.full_names()) {
    const std::string holder = name.substr(0, name.find(':'));
    if (catalogue.empty() || CLI::detail::to_lower(holder) == CLI::detail::to_lower(catalogue))
      glasses.push_back(all.find(name));
  }
  if (glasses.empty())
    throw InputError(fmt::format("there is no glass catalogue {}; the known are {}", catalogue,
                                 fmt::join(all.catalogues(), ", ")));
  return glasses;
}

json summary_of(const Glass& glass) {
  const std::optional<AbbeNumbers> abbe = glass.abbe();
  const auto or_null = [](auto present, double value) { return present ? json(value) : json(nullptr); };
  return {{"name", glass.full_name()},
          {"nd", or_null(abbe, abbe ? abbe->nd : 0)},
          {"vd", or_null(abbe, abbe ? abbe->vd : 0)},
          {"shortest_nm", glass.shortest_nm},
          {"longest_nm", glass.longest_nm},
          {"status", glass.status.empty() ? json(nullptr) : json(glass.status)}};
}

std::string summary_line(const Glass& glass) {
  const std::optional<AbbeNumbers> abbe = glass.abbe();
  const std::string numbers =
      abbe ? fmt::format("{:9.6f} {:7.3f}", abbe->nd, abbe->vd) : fmt::format("{:>9} {:>7}", "-", "-");
  return fmt::format("{:<28} {} {:>8} {:>8}  {}", glass.full_name(), numbers, glass.shortest_nm,
                     glass.longest_nm, glass.status.empty() ? "-" : glass.status);
}

std::string summary_heading() {
  return fmt::format("{:<28} {:>9} {:>7} {:>8} {:>8}  {}", "name", "nd", "Vd", "from_nm", "to_nm", "status");
}

// --- list

/// Whether the name holds these letters, whatever their case.
bool holds(const std::string& name, const std::string& letters) {
  return std::search(name.begin(), name.end(), letters.begin(), letters.end(),
                     [](unsigned char a, unsigned char b) { return std::toupper(a) == std::toupper(b); }) !=
         name.end();
}

void list(const Shared& shared, const GlassCatalogue& all, const std::string& catalogue,
          const std::string& letters) {
  std::vector<GlassPointer> glasses = glasses_of(all, catalogue);
  std::erase_if(glasses, [&](const GlassPointer& glass) { return !holds(glass->name, letters); });
  if (glasses.empty())
    throw InputError(
        fmt::format("no glass has {} in its name; petzval glass find --nd 1.62 --vd 60 finds the "
                    "nearest to an index",
                    letters));
  if (shared.json) {
    json rows = json::array();
    for (const GlassPointer& glass : glasses) rows.push_back(summary_of(*glass));
    print_json({{"rows", rows}});
    return;
  }
  fmt::print("{}\n", summary_heading());
  for (const GlassPointer& glass : glasses) fmt::print("{}\n", summary_line(*glass));
}

// --- show

/// The lines of the catalogues that the glass covers.
std::vector<double> usual_wavelengths(const Glass& glass) {
  using namespace spectral_line;
  std::vector<double> covered;
  for (const double nm : {g_nm, f_nm, e_nm, d_nm, c_nm})
    if (nm >= glass.shortest_nm && nm <= glass.longest_nm) covered.push_back(nm);
  if (covered.empty()) covered = {glass.shortest_nm, glass.longest_nm};
  return covered;
}

/// Absorption is null where the catalogue has none.
json rows_of(const Glass& glass, const std::vector<double>& wavelengths_nm) {
  json rows = json::array();
  for (const double nm : wavelengths_nm) {
    json row = {{"wavelength_nm", nm},
                {"index", glass.index(nm)},
                {"extinction", nullptr},
                {"transmittance_10mm", nullptr}};
    if (!glass.k_table.empty()) {
      row["extinction"] = glass.extinction(nm);
      row["transmittance_10mm"] = glass.transmittance_10mm(nm);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string formula_of(const Glass& glass) {
  return glass.formula == 0 ? fmt::format("table of {} indices", glass.n_table.size())
                            : dispersion_formula_text(glass.formula);
}

json description_of(const Glass& glass, const json& rows) {
  const auto or_null = [](const std::optional<double>& value) {
    return value ? json(*value) : json(nullptr);
  };
  json description = summary_of(glass);
  description.update({{"formula", glass.formula},
                      {"formula_text", formula_of(glass)},
                      {"coefficients", glass.coefficients},
                      {"stated_nd", or_null(glass.stated_nd)},
                      {"stated_vd", or_null(glass.stated_vd)},
                      {"rows", rows}});
  return description;
}

void print_description(const Glass& glass, const json& rows) {
  const auto stated = [](const std::optional<double>& value) {
    return value ? fmt::format("  (the maker states {})", *value) : "";
  };
  fmt::print("{}\n", glass.full_name());
  fmt::print("formula       {}\n", formula_of(glass));
  if (!glass.coefficients.empty()) fmt::print("coefficients  {}\n", fmt::join(glass.coefficients, " "));
  fmt::print("valid         {} to {} nm, relative to air\n", glass.shortest_nm, glass.longest_nm);
  if (const auto abbe = glass.abbe()) {
    fmt::print("nd            {:.6f}{}\n", abbe->nd, stated(glass.stated_nd));
    fmt::print("Vd            {:.4f}{}\n", abbe->vd, stated(glass.stated_vd));
  }
  if (!glass.status.empty()) fmt::print("status        {}\n", glass.status);
  fmt::print("{:>13} {:>11} {:>11} {:>12}\n", "wavelength_nm", "n", "k", "T_10mm");
  for (const json& row : rows) {
    const bool absorbs = !row["extinction"].is_null();
    fmt::print("{:>13} {:>11.8f} {:>11} {:>12}\n", row["wavelength_nm"].get<double>(),
               row["index"].get<double>(),
               absorbs ? fmt::format("{:.4e}", row["extinction"].get<double>()) : "-",
               absorbs ? fmt::format("{:.6f}", row["transmittance_10mm"].get<double>()) : "-");
  }
}

void show(const Shared& shared, const GlassCatalogue& all, const std::string& name,
          const std::vector<double>& wavelengths_nm) {
  const GlassPointer glass = all.find(name);
  // All indices are computed before anything is printed, so that an error leaves no half of an answer.
  const json rows = rows_of(*glass, wavelengths_nm.empty() ? usual_wavelengths(*glass) : wavelengths_nm);
  if (shared.json) {
    print_json(description_of(*glass, rows));
  } else {
    print_description(*glass, rows);
  }
}

// --- find

struct Wanted {
  std::optional<double> nd, vd;
  std::string catalogue;
  int count = 10;
};

/// One unit of Vd counts as much as 0.01 of nd: about the shape of the glass map.
constexpr double nd_per_vd = 0.01;

double distance(const AbbeNumbers& glass, const Wanted& wanted) {
  const double in_nd = wanted.nd ? glass.nd - *wanted.nd : 0;
  const double in_vd = wanted.vd ? nd_per_vd * (glass.vd - *wanted.vd) : 0;
  return std::hypot(in_nd, in_vd);
}

void find(const Shared& shared, const GlassCatalogue& all, const Wanted& wanted) {
  if (!wanted.nd && !wanted.vd) throw InputError("glass find needs --nd, --vd or both");
  for (const auto& [option, value] : {std::pair{"--nd", wanted.nd}, {"--vd", wanted.vd}})
    if (value && !(std::isfinite(*value) && *value > 0))
      throw InputError(fmt::format("{} {}: a positive number is wanted", option, *value));
  std::vector<std::pair<double, GlassPointer>> ranked;
  for (const GlassPointer& glass : glasses_of(all, wanted.catalogue))
    if (const auto abbe = glass->abbe()) ranked.emplace_back(distance(*abbe, wanted), glass);
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  ranked.resize(std::min(ranked.size(), static_cast<std::size_t>(wanted.count)));
  if (shared.json) {
    json rows = json::array();
    for (const auto& [far, glass] : ranked) {
      rows.push_back(summary_of(*glass));
      rows.back()["distance"] = far;
    }
    print_json({{"distance", "sqrt((nd - nd0)^2 + (0.01 (vd - vd0))^2)"}, {"rows", rows}});
    return;
  }
  fmt::print("{:>9}  {}\n", "distance", summary_heading());
  for (const auto& [far, glass] : ranked) fmt::print("{:9.6f}  {}\n", far, summary_line(*glass));
}

}  // namespace

void add_glass_commands(CLI::App& app, Shared& shared) {
  CLI::App* glass = app.add_subcommand("glass", "Look up glasses of the bundled catalogues and of your own");
  glass->require_subcommand(1);
  const auto own = std::make_shared<GlassChoice>();

  const auto catalogue = std::make_shared<std::string>(), letters = std::make_shared<std::string>();
  CLI::App* list_command = add_command(
      *glass, shared, "list", "List glasses with nd, Vd and valid range",
      "petzval glass list --catalogue SCHOTT", true,
      [&shared, own, catalogue, letters] { list(shared, own->read(shared), *catalogue, *letters); });
  list_command->add_option("name", *letters, "Only glasses with this in their name: SK16");
  list_command->add_option("--catalogue", *catalogue, "Only this catalogue, for example SCHOTT");

  const auto name = std::make_shared<std::string>();
  const auto wavelengths_nm = std::make_shared<std::vector<double>>();
  CLI::App* show_command = add_command(
      *glass, shared, "show", "Show a glass: formula, coefficients, range, index and absorption",
      "petzval glass show SCHOTT:N-BK7 --wavelengths 486.13,587.56", true,
      [&shared, own, name, wavelengths_nm] { show(shared, own->read(shared), *name, *wavelengths_nm); });
  show_command->add_option("name", *name, "CATALOGUE:NAME, or NAME where only one catalogue has it")
      ->required();
  show_command->add_option_function<std::string>(
      "--wavelengths",
      [wavelengths_nm](const std::string& text) { *wavelengths_nm = parse_wavelength_list(text); },
      "Wavelengths in nm, 450,550 or 400:50:700 (default: the lines g F e d C)");

  const auto wanted = std::make_shared<Wanted>();
  CLI::App* find_command = add_command(*glass, shared, "find",
                                       "Find the glasses nearest to nd and Vd: by the square root of "
                                       "(nd - nd0)^2 + (0.01 (Vd - Vd0))^2",
                                       "petzval glass find --nd 1.6 --vd 60 --count 5", true,
                                       [&shared, own, wanted] { find(shared, own->read(shared), *wanted); });
  find_command->add_option("--nd", wanted->nd, "Index wanted at 587.56 nm");
  find_command->add_option("--vd", wanted->vd, "Abbe number wanted");
  find_command->add_option("--count", wanted->count, "How many to show")->check(CLI::Range(1, 100000));
  find_command->add_option("--catalogue", wanted->catalogue, "Only this catalogue");
  for (CLI::App* command : {list_command, show_command, find_command}) own->add_to(*command);
}

}  // namespace petzval::app
