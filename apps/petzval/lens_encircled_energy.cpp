// SPDX-License-Identifier: BSD-3-Clause
// petzval lens encircled-energy: how much of a point's light falls within circles.
#include <fmt/format.h>
#include <petzval/analysis/encircled_energy.h>
#include <petzval/base/whole_file.h>
#include <petzval/report/colours.h>
#include <petzval/report/svg_plot.h>

#include <algorithm>

#include "analysis_command.h"
#include "lens_commands.h"

namespace petzval::app {

namespace {

struct EncircledEnergyCommand : AnalysisCommand {
  EncircledEnergyOptions energy;
  bool about_chief = false;
};

Plot energy_plot(Fields::Kind kind, const std::vector<EncircledEnergyRow>& rows) {
  Plot plot;
  plot.title = "Encircled energy, dashed without aberration";
  plot.x = {"radius", "µm"};
  plot.x.from = 0;
  plot.y = {"share of the light", ""};
  plot.y.from = 0;
  plot.y.to = 1;
  for (std::size_t start = 0, end = 0; start < rows.size(); start = end) {
    std::vector<double> radius, share, airy;
    for (end = start; end < rows.size() && rows[end].field == rows[start].field &&
                      rows[end].wavelength_nm == rows[start].wavelength_nm;
         ++end) {
      radius.push_back(rows[end].radius_um);
      share.push_back(rows[end].encircled_energy);
      airy.push_back(rows[end].airy);
    }
    const std::string colour = series_colour(plot.series.size() / 2).hex();
    PlotSeries& line = plot.line(
        fmt::format("{:g} {}, {:g} nm", rows[start].field, field_unit(kind), rows[start].wavelength_nm),
        radius, share);
    line.colour = colour;
    PlotSeries& limit = plot.line("", radius, airy);
    limit.colour = colour;
    limit.stroke = PlotStroke::dashed;
    limit.width_px = 1;
  }
  return plot;
}

void encircled_energy(const EncircledEnergyCommand& command, const Shared& shared) {
  const Lens lens = command.fields.prepare(command.lens.read(shared), shared);
  const FieldTableRequest request = command.fields.request(lens);
  EncircledEnergyOptions options = command.energy;
  options.about_centroid = !command.about_chief;
  std::sort(options.radii_um.begin(), options.radii_um.end());
  const std::vector<EncircledEnergyRow> rows = encircled_energy_table(lens, request, options);
  if (!command.plot.empty())
    write_whole_file(command.plot, plot_grid_svg({energy_plot(request.field_kind, rows)}, 1, lens.name));
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
