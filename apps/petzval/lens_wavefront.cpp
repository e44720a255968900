// SPDX-License-Identifier: BSD-3-Clause
// petzval lens wavefront: RMS and peak-to-valley wavefront aberration, Strehl ratio.
#include <fmt/format.h>
#include <petzval/analysis/wavefront.h>
#include <petzval/base/whole_file.h>
#include <petzval/report/pupil_plots.h>

#include "analysis_command.h"
#include "lens_commands.h"
#include "output_option.h"

namespace petzval::app {

namespace {

struct WavefrontCommand : AnalysisCommand {
  std::string map;
  int samples = 64;
};

void write_map(const WavefrontCommand& options, const Lens& lens, FieldTableRequest request) {
  const std::vector<WavefrontMap> maps = wavefront_maps(lens, request, options.samples);
  if (options.map.ends_with(".csv"))
    return write_whole_file(options.map, to_csv(tabulate(request.field_kind, maps)));
  const auto across = static_cast<int>(std::max<std::size_t>(request.wavelengths_nm.size(), 3));
  write_whole_file(options.map, plot_grid_svg(wavefront_map_plots(request.field_kind, maps), across,
                                              lens.name + ": wavefront over the stop"));
}

void wavefront(const WavefrontCommand& options, const Shared& shared) {
  if (!options.map.empty()) require_extension(options.map, {".svg", ".csv"}, "a wavefront map");
  const Lens lens = options.prepare(shared);
  const FieldTableRequest request = options.fields.request(lens);
  const std::vector<WavefrontRow> rows = wavefront_table(lens, request);
  if (!options.plot.empty()) {
    const Plot plot = wavefront_plot(request.field_kind, rows);
    write_whole_file(options.plot, plot_grid_svg({plot}, 1, lens.name));
  }
  if (!options.map.empty()) write_map(options, lens, request);
  if (shared.json) {
    nlohmann::ordered_json json = analysis_json(lens, request);
    for (const WavefrontRow& row : rows)
      json["rows"].push_back(
          {{"field", row.field},
           {"wavelength_nm", row.wavelength_nm},
           {"real_image_height_mm", row.real_image_height_mm},
           {"rms_waves", row.rms_waves},
           {"rms_without_tilt_waves", row.rms_without_tilt_waves},
           {"pv_waves", row.pv_waves},
           {"strehl", row.strehl},
           {"reference_sphere_radius_mm", number_or_null(row.reference_sphere_radius_mm)}});
    return print_json(json);
  }
  fmt::print("{}: wavefront aberration about the chief ray's image point, piston removed\n", lens.name);
  fmt::print("{:>28} {:>15} {:>18} {:>12} {:>20} {:>11} {:>9}\n", field_heading(request.field_kind),
             "wavelength [nm]", "image height [mm]", "RMS [waves]", "without tilt [waves]", "PV [waves]",
             "Strehl");
  for (const WavefrontRow& row : rows)
    fmt::print("{:>28g} {:>15g} {:>18.6f} {:>12.5f} {:>20.5f} {:>11.4f} {:>9.5f}\n", row.field,
               row.wavelength_nm, row.real_image_height_mm, row.rms_waves, row.rms_without_tilt_waves,
               row.pv_waves, row.strehl);
}

}  // namespace

void add_lens_wavefront(CLI::App& lens, Shared& shared) {
  auto options = std::make_shared<WavefrontCommand>();
  CLI::App* command = add_analysis_command(
      lens, shared, "wavefront", "Wavefront aberration and Strehl ratio by field and wavelength",
      "petzval lens wavefront double-gauss --wavelengths 587.56 --map map.svg --plot wavefront.svg", options,
      [](const WavefrontCommand& chosen, const Shared& all) { wavefront(chosen, all); });
  command
      ->add_option("--map", options->map,
                   "Also write the wavefront over the stop, as pictures (.svg) or numbers (.csv)")
      ->check(output_file());
  command->add_option("--samples", options->samples, "Samples a side of a map")->check(CLI::Range(3, 1025));
}

}  // namespace petzval::app
