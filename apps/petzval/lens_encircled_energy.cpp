// SPDX-License-Identifier: BSD-3-Clause
// petzval lens encircled-energy: how much of a point's light falls within circles.
#include <fmt/format.h>
#include <petzval/analysis/encircled_energy.h>
#include <petzval/base/whole_file.h>
#include <petzval/report/analysis_plots.h>

#include <algorithm>

#include "analysis_command.h"
#include "lens_commands.h"

namespace petzval::app {

namespace {

struct EncircledEnergyCommand : AnalysisCommand {
  EncircledEnergyOptions energy;
  bool about_chief = false;
};

void encircled_energy(const EncircledEnergyCommand& command, const Shared& shared) {
  const Lens lens = command.fields.prepare(command.lens.read(shared), shared);
  const FieldTableRequest request = command.fields.request(lens);
  EncircledEnergyOptions options = command.energy;
  options.about_centroid = !command.about_chief;
  std::sort(options.radii_um.begin(), options.radii_um.end());
  const std::vector<EncircledEnergyRow> rows = encircled_energy_table(lens, request, options);
  if (!command.plot.empty())
    write_whole_file(command.plot,
                     plot_grid_svg({encircled_energy_plot(request.field_kind, rows)}, 1, lens.name));
  if (shared.json) {
    nlohmann::ordered_json json = analysis_json(lens, request);
    json["about"] = options.about_centroid ? "centroid" : "chief ray";
    for (const EncircledEnergyRow& row : rows)
      json["rows"].push_back({{"field", row.field},
                              {"wavelength_nm", row.wavelength_nm},
                              {"radius_um", row.radius_um},
                              {"encircled_energy", number_or_null(row.encircled_energy)},
                              {"airy", row.airy}});
    return print_json(json);
  }
  fmt::print("{}: shares of the light within circles about the {}\n", lens.name,
             options.about_centroid ? "centroid" : "chief ray");
  fmt::print("{:>28} {:>15} {:>11} {:>16} {:>8}\n", field_heading(request.field_kind), "wavelength [nm]",
             "radius [um]", "encircled energy", "Airy");
  for (const EncircledEnergyRow& row : rows)
    fmt::print("{:>28g} {:>15g} {:>11.4g} {:>16.5f} {:>8.5f}\n", row.field, row.wavelength_nm, row.radius_um,
               row.encircled_energy, row.airy);
}

}  // namespace

void add_lens_encircled_energy(CLI::App& lens, Shared& shared) {
  auto options = std::make_shared<EncircledEnergyCommand>();
  CLI::App* command = add_analysis_command(
      lens, shared, "encircled-energy", "Share of a point's light within circles, by field and wavelength",
      "petzval lens encircled-energy double-gauss --radii 2,5,10,20 --plot encircled.svg", options,
      [](const EncircledEnergyCommand& chosen, const Shared& all) { encircled_energy(chosen, all); });
  command
      ->add_option("--radii", options->energy.radii_um,
                   "Radii on the sensor [um], separated by commas; default: 32 out to the wings")
      ->delimiter(',')
      ->check(CLI::NonNegativeNumber);
  command->add_flag("--about-chief-ray", options->about_chief,
                    "Circles about the chief ray, not the centroid");
}

}  // namespace petzval::app
