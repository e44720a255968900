// SPDX-License-Identifier: BSD-3-Clause
// petzval lens wavefront: RMS and peak-to-valley wavefront aberration, Strehl ratio.
#include <fmt/format.h>
#include <petzval/analysis/wavefront.h>
#include <petzval/base/whole_file.h>
#include <petzval/report/colours.h>
#include <petzval/report/svg_plot.h>

#include "analysis_command.h"
#include "lens_commands.h"

namespace petzval::app {

namespace {

void write_plot(const std::string& path, const Lens& lens, const FieldTableRequest& request,
                const std::vector<WavefrontRow>& rows) {
  Plot plot;
  plot.title = lens.name + ": RMS wavefront aberration, piston removed";
  plot.x = {"field", field_unit(request.field_kind)};
  plot.y = {"RMS wavefront aberration", "waves", PlotScale::linear, 0.0, {}};
  const std::size_t wavelengths = request.wavelengths_nm.size();
  for (std::size_t w = 0; w < wavelengths; ++w) {
    std::vector<double> fields, waves;
    for (std::size_t i = w; i < rows.size(); i += wavelengths) {
      fields.push_back(rows[i].field);
      waves.push_back(rows[i].rms_waves);
    }
    PlotSeries& line = plot.line(fmt::format("{:g} nm", request.wavelengths_nm[w]), fields, waves);
    line.colour = wavelength_colour(request.wavelengths_nm[w]).hex();
    line.marker = PlotMarker::dot;
  }
  write_whole_file(path, plot.svg());
}

void wavefront(const AnalysisCommand& options, const Shared& shared) {
  const Lens lens = options.fields.prepare(options.lens.read(shared), shared);
  const FieldTableRequest request = options.fields.request(lens);
  const std::vector<WavefrontRow> rows = wavefront_table(lens, request);
  if (!options.plot.empty()) write_plot(options.plot, lens, request, rows);
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
  add_analysis_command(
      lens, shared, "wavefront", "Wavefront aberration and Strehl ratio by field and wavelength",
      "petzval lens wavefront double-gauss --plot wavefront.svg", std::make_shared<AnalysisCommand>(),
      [](const AnalysisCommand& chosen, const Shared& all) { wavefront(chosen, all); });
}

}  // namespace petzval::app
