// SPDX-License-Identifier: BSD-3-Clause
// petzval lens fit-build.
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/quantities.h>
#include <petzval/base/staged_files.h>
#include <petzval/base/whole_file.h>
#include <petzval/lens/lens_file.h>
#include <petzval/report/fit_build_tables.h>

#include <algorithm>
#include <memory>

#include "camera_option.h"
#include "field_option.h"
#include "lens_commands.h"
#include "option_names.h"
#include "output_option.h"
#include "plot_output.h"
#include "table_output.h"

namespace petzval::app {

namespace {

struct FitBuildCommand {
  LensChoice lens;
  CameraChoice camera;
  FitBuildRequest request;
  std::vector<std::string> maps;
  std::string wavelengths, focus_shifts, map, csv, output;
  std::optional<double> pitch_um;
};

nlohmann::ordered_json others_json(const FitBuildResult& result) {
  nlohmann::ordered_json others = nlohmann::ordered_json::array();
  for (const OtherBuild& other : result.others)
    others.push_back({{"values", other.values}, {"chi_squared", other.chi_squared}});
  return others;
}

void print_as_json(const FitBuildCommand& command, const FitBuildResult& result) {
  nlohmann::ordered_json json = {{"lens", result.lens.name},
                                 {"output", command.output},
                                 {"rows", rows_json(fitted_numbers(result))},
                                 {"correlation", result.correlation},
                                 {"chi_squared_before", result.chi_squared_before},
                                 {"chi_squared", result.chi_squared},
                                 {"freedom", result.freedom},
                                 {"scaled_by", result.scaled_by},
                                 {"others", others_json(result)},
                                 {"remarks", result.remarks},
                                 {"edges", rows_json(fitted_edges(result))}};
  print_json(json);
}

void print_as_text(const FitBuildResult& result) {
  fmt::print("{}: {} edges, chi2 {:.1f} for {} degrees of freedom, {:.1f} as designed\n", result.lens.name,
             result.edges.size(), result.chi_squared, result.freedom, result.chi_squared_before);
  print_table(fitted_numbers_to_read(result));
  if (result.scaled_by > 1)
    fmt::print("deviations are {:.2f} times what the stated ones give, for so much worse is the fit\n",
               result.scaled_by);
  for (const std::string& remark : result.remarks) fmt::print("{}\n", with_option_names(remark));
}

void take_sensor(FitBuildCommand& command) {
  if (!command.camera.sensor.empty()) {
    const Sensor sensor = read_sensor(command.camera.sensor, command.camera.sensor_settings);
    command.request.pixel_pitch_um = sensor.geometry.pitch_um;
    command.request.photosite = sensor.photosite;
  }
  if (command.pitch_um) command.request.pixel_pitch_um = *command.pitch_um;
}

void run(FitBuildCommand command, const Shared& shared) {
  if (!command.map.empty()) require_drawing(command.map, "a map");
  if (!command.csv.empty()) require_extension(command.csv, {".csv"}, "a table");
  take_sensor(command);
  std::vector<SfrMap> photographs;
  for (const std::string& path : command.maps)
    for (SfrMap& map : read_sfr_maps(path)) photographs.push_back(std::move(map));
  FitBuildRequest& request = command.request;
  if (!command.wavelengths.empty()) request.wavelengths_nm = parse_wavelength_list(command.wavelengths);
  if (!command.focus_shifts.empty())
    request.focus_shifts_mm = parse_number_list(command.focus_shifts, "focus_shifts_mm");
  const Lens lens = command.camera.used(command.lens.read(shared), {}, shared);
  const FitBuildResult result = fit_build(lens, photographs, request, context_of(shared));
  StagedFiles files;
  if (!command.csv.empty()) write_whole_file(files.stage(command.csv), to_csv(fitted_edges(result)));
  if (!command.map.empty())
    write_drawing(files.stage(command.map),
                  fit_build_map_svg(result, photographs.front().columns, photographs.front().rows),
                  command.map);
  files.commit();
  if (!command.output.empty())
    for (const std::string& line : write_lens(result.lens, command.output)) note(shared, line);
  shared.json ? print_as_json(command, result) : print_as_text(result);
}

}  // namespace

void add_lens_fit_build(CLI::App& lens, Shared& shared) {
  auto options = std::make_shared<FitBuildCommand>();
  CLI::App* command = add_command(lens, shared, "fit-build",
                                  "How a lens was built, from the sharpness of edges over a photograph",
                                  "petzval lens fit-build edmund-54852 --sfr map.json --pixel-pitch 4.73 "
                                  "--wavelengths 550 --free defocus_mm -o as-built.json",
                                  true, [options, &shared] { run(*options, shared); });
  options->lens.add_to(*command);
  command
      ->add_option(
          "--sfr", options->maps,
          "What sfr --json printed of a photograph; several of different focus settings, or one file "
          "of several pictures, are explained by one build")
      ->required()
      ->take_all()
      ->allow_extra_args(false);
  command
      ->add_option("--free", options->request.free,
                   "What may be off: defocus_mm, sensor_tilt_deg, element_decentre_mm@2-3, "
                   "element_tilt_deg@2-3, another kind of lens tolerance, or sag4_um@0 (a term of r^4), with "
                   "=LIMIT for what its maker keeps (repeatable); default: defocus_mm and sensor_tilt_deg")
      ->take_all()
      ->allow_extra_args(false);
  command->add_option("--focus-shifts", options->focus_shifts,
                      "Where the sensor stood in each photograph against the first, away from the lens [mm], "
                      "separated by commas; default: not known, each has a defocus of its own");
  options->camera.add_sensor(*command, "That took the photographs: its pitch and photosite");
  command->add_option("--pixel-pitch", options->pitch_um, "Of the photographs [um], in place of a sensor")
      ->check(positive_number());
  command->add_option("--wavelengths", options->wavelengths,
                      "Of the light [nm], separated by commas; default: the lens's own");
  command
      ->add_option("--weights", options->request.weights,
                   "Of the light of each wavelength, separated by commas; default: all alike")
      ->delimiter(',')
      ->check(number_not_negative());
  command
      ->add_option("--channel", options->request.channel,
                   "Whose edges count; default: luminance, or green where there are colours")
      ->check(CLI::IsMember({"luminance", "red", "green", "blue"}));
  options->camera.add_stop_and_focus(*command, Focus::design());
  command
      ->add_option("--map", options->map, "Draw measured and fitted MTF50 over the frame: .svg, .png or .pdf")
      ->check(output_file());
  command->add_option("--csv", options->csv, "Write every edge, measured, designed and fitted: .csv")
      ->check(output_file());
  command->add_option("-o,--output", options->output, "Write the lens as built: .json")->check(output_file());
}

}  // namespace petzval::app
