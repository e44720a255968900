// SPDX-License-Identifier: BSD-3-Clause
// petzval lens report: one page about a lens, or about several.
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/version.h>
#include <petzval/base/whole_file.h>
#include <petzval/report/lens_report.h>
#include <petzval/sensor/sensor.h>

#include <memory>

#include "camera_option.h"
#include "field_option.h"
#include "lens_commands.h"
#include "output_option.h"

namespace petzval::app {

namespace {

struct ReportCommand {
  std::vector<std::string> lenses;
  LensChoice choice;  ///< --set and --substitute, for each lens
  FieldChoice fields;
  CameraChoice camera;
  LensReportOptions report;
  std::string sensor, output;
};

void report(const ReportCommand& options, const Shared& shared) {
  require_extension(options.output, {".html", ".htm"}, "a report");
  LensReportOptions chosen = options.report;
  if (!options.sensor.empty()) {
    const Sensor sensor = read_sensor(options.sensor);
    chosen.sensor = ReportSensor{
        sensor.name, sensor.geometry.pitch_um, sensor.geometry.half_diagonal_mm(), sensor.photosite, {}, {}};
    if (sensor.electronics && sensor.electronics->microlens) {
      chosen.sensor->microlens_heights_mm = sensor.electronics->microlens->design_heights_mm;
      chosen.sensor->microlens_angles_deg = sensor.electronics->microlens->design_angles_deg;
    }
  }
  std::vector<ReportLens> lenses;
  for (const std::string& name : options.lenses) {
    LensChoice choice = options.choice;
    choice.path_or_name = name;
    const Lens read = options.fields.prepare(choice.read(shared), shared);
    const Lens lens = options.camera.used(read, options.fields.request(read), shared);
    lenses.push_back({lens, options.fields.request(lens)});
    lenses.back().request.azimuth_deg = options.camera.field_azimuth_deg;
  }
  chosen.footer = fmt::format(
      "petzval {}; lengths in mm, wavelengths in nm, angles in degrees; definitions: "
      "docs/CONVENTIONS.md and docs/ANALYSES.md of Petzval.",
      version());
  const std::string page = lens_report_html(lenses, chosen);
  write_whole_file(options.output, page);
  if (!shared.quiet)
    fmt::print("{}: {} lens{}\n", options.output, lenses.size(), lenses.size() == 1 ? "" : "es");
}

}  // namespace

void add_lens_report(CLI::App& lens, Shared& shared) {
  auto options = std::make_shared<ReportCommand>();
  CLI::App* command =
      add_command(lens, shared, "report", "One page with every analysis, for a designer to read and print",
                  "petzval lens report cooke-triplet --sensor third-inch-vga -o report.html", false,
                  [=, &shared] { report(*options, shared); });
  command->add_option("lens", options->lenses, "Lens files or names of bundled lenses; several are compared")
      ->required();
  options->choice.add_settings_to(*command);
  options->fields.add_to(*command);
  options->camera.add_to(*command);
  command->add_option("--sensor", options->sensor,
                      "Also look at this sensor: a name, a file or COLUMNSxROWS@PITCH_UM");
  command
      ->add_option("--frequencies", options->report.frequencies_cpmm,
                   "Spatial frequencies of tables and of curves over field and focus [cycles/mm]")
      ->delimiter(',')
      ->check(positive_number());
  command
      ->add_option("--highest-frequency", options->report.highest_frequency_cpmm,
                   "Where MTF curves end [cycles/mm]")
      ->check(positive_number());
  command->add_option("-o,--output", options->output, "HTML file to write")->check(output_file())->required();
}

}  // namespace petzval::app
