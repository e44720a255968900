// SPDX-License-Identifier: BSD-3-Clause
// petzval lens spots: spot sizes and spot diagrams.
#include <fmt/format.h>
#include <petzval/analysis/spots.h>
#include <petzval/base/whole_file.h>
#include <petzval/report/pupil_plots.h>

#include "analysis_command.h"
#include "lens_commands.h"

namespace petzval::app {

namespace {

struct SpotsCommand : AnalysisCommand {
  bool by_light = false;
};

/// Rings of rays in a spot diagram: 3·8·9 = 216 points.
constexpr int diagram_rings = 8;

void spots(const SpotsCommand& options, const Shared& shared) {
  const Lens lens = options.prepare(shared);
  const FieldTableRequest request = options.fields.request(lens);
  const std::vector<SpotRow> rows =
      spot_table(lens, request, options.by_light ? RayWeight::light : RayWeight::stop_area);
  if (!options.plot.empty()) {
    const Plot plot = spot_plot(request.field_kind, spot_diagrams(lens, request, diagram_rings), rows);
    write_whole_file(options.plot, plot_grid_svg({plot}, 1, lens.name));
  }
  if (shared.json) {
    nlohmann::ordered_json json = analysis_json(lens, request);
    for (const SpotRow& row : rows)
      json["rows"].push_back({{"field", row.field},
                              {"wavelength_nm", row.wavelength_nm},
                              {"real_image_height_mm", row.real_image_height_mm},
                              {"centroid_um", row.centroid_um},
                              {"rms_radius_um", row.rms_radius_um},
                              {"rms_x_um", row.rms_x_um},
                              {"rms_y_um", row.rms_y_um},
                              {"max_radius_um", row.max_radius_um},
                              {"airy_radius_um", row.airy_radius_um}});
    return print_json(json);
  }
  fmt::print("{}: spot radii about the centroid, rays weighted by {}\n", lens.name,
             options.by_light ? "their light" : "area on the stop");
  fmt::print("{:>28} {:>15} {:>18} {:>14} {:>9} {:>11} {:>11} {:>9} {:>10}\n",
             field_heading(request.field_kind), "wavelength [nm]", "image height [mm]", "centroid [um]",
             "RMS [um]", "RMS x [um]", "RMS y [um]", "max [um]", "Airy [um]");
  for (const SpotRow& row : rows)
    fmt::print("{:>28g} {:>15g} {:>18.6f} {:>14.4f} {:>9.4f} {:>11.4f} {:>11.4f} {:>9.4f} {:>10.4f}\n",
               row.field, row.wavelength_nm, row.real_image_height_mm, row.centroid_um, row.rms_radius_um,
               row.rms_x_um, row.rms_y_um, row.max_radius_um, row.airy_radius_um);
}

}  // namespace

void add_lens_spots(CLI::App& lens, Shared& shared) {
  auto options = std::make_shared<SpotsCommand>();
  CLI::App* command =
      add_analysis_command(lens, shared, "spots", "Spot sizes by field and wavelength, and spot diagrams",
                           "petzval lens spots cooke-triplet --plot spots.svg", options,
                           [](const SpotsCommand& chosen, const Shared& all) { spots(chosen, all); });
  command->add_flag("--by-light", options->by_light,
                    "Weight rays by the light they carry, not by their area on the stop");
}

}  // namespace petzval::app
