// SPDX-License-Identifier: BSD-3-Clause
// petzval lens report: one page about a lens, or about several.
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/quantities.h>
#include <petzval/base/units.h>
#include <petzval/base/version.h>
#include <petzval/base/whole_file.h>
#include <petzval/report/lens_report.h>
#include <petzval/sensor/sensor.h>
#include <petzval/simulate/lens_on_sensor.h>

#include <cmath>
#include <memory>
#include <set>

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
  std::string sensor, distance, output;
};

/// What the lenses do for the sensor, beside each other.
ReportChapter sensor_chapter(const ReportCommand& options, const LensChoice& lenses, const Shared& shared) {
  std::optional<double> distance_m;
  if (const double asked_m =
          options.distance.empty() ? INFINITY : parse_distance_m(options.distance, "distance");
      std::isfinite(asked_m))
    distance_m = asked_m;
  Context context = context_of(shared);
  context.progress = {};
  std::vector<LensOnSensor> rows;
  for (const std::string& name : options.lenses) {
    CameraChoice choice = options.camera;
    choice.lens = lenses.for_lens(name);
    choice.sensor = options.sensor;
    choice.usual_focus = Focus::automatic();
    const Camera camera = choice.camera(shared);
    // A lens that was computed for a distance stands at that one.
    std::optional<double> here_m = distance_m;
    if (options.distance.empty() && camera.lens.object_distance_mm)
      here_m = (*camera.lens.object_distance_mm + camera.lens.total_track_mm()) / mm_per_m;
    rows.push_back(lens_on_sensor(camera, here_m, {}, context));
    rows.back().lens = camera.lens.name;
  }
  return {
      fmt::format("Which lens for {}", read_sensor(options.sensor).name),
      fmt::format(
          "The object is {}; lenses are focused for the best mean MTF at half of Nyquist over middle, half "
          "way and corner unless a focus was asked for. MTF tangential / sagittal, of the lens's "
          "wavelengths together; Nyquist is {:.4g} cycles/mm; distances count from the sensor plane.",
          options.distance.empty() ? "where each lens's file has it" : options.distance + " away",
          rows.front().nyquist_cpmm),
      lens_on_sensor_table(rows)};
}

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
  if (options.sensor.empty() && !options.distance.empty())
    throw InputError("--distance is that of the chapter about a sensor; --sensor would be right with it");
  std::vector<ReportLens> lenses;
  LensChoice choices = options.choice;
  if (options.lenses.size() > 1) choices.substituted = std::make_shared<std::set<std::string>>();
  for (const std::string& name : options.lenses) {
    const Lens read = options.fields.prepare(choices.for_lens(name).read(shared), shared);
    const Lens lens = options.camera.used(read, options.fields.request(read), shared);
    lenses.push_back({lens, options.fields.request(lens)});
    lenses.back().request.azimuth_deg = options.camera.field_azimuth_deg;
  }
  if (choices.substituted) choices.require_all_substituted();
  if (!options.sensor.empty()) {
    Shared once = shared;
    once.quiet = true;  // the readers' notes were printed
    chosen.chapters.push_back(sensor_chapter(options, choices, once));
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
  command->add_option("--distance", options->distance,
                      "Of the object before it: 400mm, 1.2m, infinity; default: as the lens's file has it");
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
