// SPDX-License-Identifier: BSD-3-Clause
// petzval lens for-sensor and match: which lens for which sensor.
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/quantities.h>
#include <petzval/simulate/lens_on_sensor.h>

#include <cmath>
#include <memory>

#include "camera_option.h"
#include "field_option.h"
#include "lens_commands.h"
#include "sensor_option.h"

namespace petzval::app {

namespace {

using nlohmann::ordered_json;

struct ForSensorCommand {
  CameraChoice camera;
  std::vector<std::string> lenses, sensor_settings;
  std::string distance, sensor, width, wavelengths;
  bool scaled = false;
};

std::vector<double> wavelengths_of(const ForSensorCommand& command) {
  return command.wavelengths.empty() ? std::vector<double>{} : parse_wavelength_list(command.wavelengths);
}

std::optional<double> distance_of(const ForSensorCommand& command) {
  const double distance_m = parse_distance_m(command.distance, "distance");
  return std::isinf(distance_m) ? std::nullopt : std::optional(distance_m);
}

ordered_json depth_json(const std::optional<DepthOfField>& depth) {
  if (!depth) return nullptr;
  return {{"near_m", depth->near_m}, {"far_m", number_or_null(depth->far_m)}};
}

ordered_json to_json(const LensOnSensor& lens) {
  const char* unit = lens.view.at_infinity ? "deg" : "mm";
  ordered_json json = {{"lens", lens.lens},
                       {"scale", lens.scale},
                       {"efl_mm", number_or_null(lens.efl_mm)},
                       {"f_number", number_or_null(lens.f_number)},
                       {"working_f_number", number_or_null(lens.working_f_number)},
                       {"magnification", lens.magnification},
                       {fmt::format("width_{}", unit), number_or_null(lens.view.width)},
                       {fmt::format("height_{}", unit), number_or_null(lens.view.height)},
                       {fmt::format("{}_per_pixel", unit), lens.per_pixel},
                       {"image_circle_mm", lens.image_circle_mm},
                       {"sensor_diagonal_mm", lens.sensor_diagonal_mm},
                       {"nyquist_cycles_per_mm", lens.nyquist_cpmm},
                       {"depth_of_field_geometric", depth_json(lens.geometric)},
                       {"depth_of_field_mtf", depth_json(lens.by_mtf)},
                       {"hyperfocal_m", number_or_null(lens.hyperfocal_m)}};
  for (const PlaceOnSensor& place : lens.places)
    json["places"].push_back({{"real_image_height_mm", place.real_image_height_mm},
                              {"mtf_half_nyquist_tangential", number_or_null(place.half_nyquist_tangential)},
                              {"mtf_half_nyquist_sagittal", number_or_null(place.half_nyquist_sagittal)},
                              {"mtf_nyquist_tangential", number_or_null(place.nyquist_tangential)},
                              {"mtf_nyquist_sagittal", number_or_null(place.nyquist_sagittal)},
                              {"relative_illumination", number_or_null(place.relative_illumination)}});
  return json;
}

void print_rows(const std::vector<LensOnSensor>& lenses, const Shared& shared) {
  if (!shared.json) {
    fmt::print("{}", to_text(lens_on_sensor_table(lenses)));
    return fmt::print(
        "MTF tangential / sagittal, Nyquist {:.4g} cycles/mm; distances from the sensor plane\n",
        lenses.front().nyquist_cpmm);
  }
  ordered_json rows = ordered_json::array();
  for (const LensOnSensor& lens : lenses) rows.push_back(to_json(lens));
  print_json({{"rows", rows}});
}

void compare(ForSensorCommand& command, const Shared& shared) {
  Context context = context_of(shared);
  context.progress = {};
  std::vector<LensOnSensor> rows;
  if (command.lenses.size() > 1) command.camera.lens.substituted = std::make_shared<std::set<std::string>>();
  for (const std::string& name : command.lenses) {
    command.camera.lens.path_or_name = name;
    Camera camera = command.camera.camera(shared);
    if (camera.sensor) note_short_field(camera.lens, camera.sensor->geometry, context);
    rows.push_back(lens_on_sensor(camera, distance_of(command), wavelengths_of(command), context));
    rows.back().lens = name;
  }
  if (command.lenses.size() > 1) command.camera.lens.require_all_substituted();
  print_rows(rows, shared);
}

void match(const ForSensorCommand& command, const Shared& shared) {
  LensMatchRequest request;
  request.sensor = read_sensor(command.sensor, command.sensor_settings);
  const std::optional<double> distance_m = distance_of(command);
  if (!distance_m)
    throw InputError("--distance infinity: a finite distance, at which --width is seen, would be right");
  request.distance_m = *distance_m;
  request.width_mm = 1e3 * parse_distance_m(command.width, "width");
  request.f_number = command.camera.f_number;
  if (!command.wavelengths.empty()) request.wavelengths_nm = wavelengths_of(command);
  request.scaled = command.scaled;
  const std::vector<LensOnSensor> found = match_lenses(request, context_of(shared));
  if (found.empty())
    throw InputError(fmt::format("no bundled lens sees {} wide at {} to the corners of the sensor{}",
                                 command.width, command.distance,
                                 command.scaled ? "" : "; --scaled lets lenses be scaled to fit"));
  print_rows(found, shared);
  if (shared.json || shared.quiet || !command.scaled) return;
  for (const LensOnSensor& lens : found)
    fmt::print("petzval lens scale {} --factor {:.6g} -o {}.json\n", lens.lens, lens.scale, lens.lens);
}

void add_distance(ForSensorCommand& options, CLI::App& command, const std::string& usual) {
  command.add_option("--distance", options.distance, "From the object to the sensor: 400mm, 1.2m, infinity")
      ->required();
  command.add_option("--wavelengths", options.wavelengths,
                     "Of the light, all alike [nm]: 450,550,650 or 400:50:700; default: " + usual);
}

}  // namespace

void add_lens_for_sensor(CLI::App& lens, Shared& shared) {
  auto options = std::make_shared<ForSensorCommand>();
  CLI::App* command =
      add_command(lens, shared, "for-sensor",
                  "What lenses do for a sensor: view, depth of field, light, MTF, beside each other",
                  "petzval lens for-sensor cooke-triplet tessar --sensor third-inch-1280x960 --distance 1.5m",
                  true, [options, &shared] { compare(*options, shared); });
  command->add_option("lenses", options->lenses, "Lens files or names of bundled lenses")->required();
  options->camera.lens.add_settings_to(*command);
  options->camera.add_stop_and_focus(*command, Focus::automatic());
  options->camera.add_apertures(*command);
  options->camera.add_sensor(*command, "Sensor, by name or file, or 768x576@6.25 (pixels @ pitch in um)");
  add_distance(*options, *command, "the lens's own");
}

void add_lens_match(CLI::App& lens, Shared& shared) {
  auto options = std::make_shared<ForSensorCommand>();
  CLI::App* command = add_command(
      lens, shared, "match", "The bundled lenses that see a width at a distance, best corner first",
      "petzval lens match --sensor third-inch-1280x960 --distance 1.5m --width 134mm", true,
      [options, &shared] { match(*options, shared); });
  command->add_option("--sensor", options->sensor, "Sensor, by name or file, or 768x576@6.25")->required();
  add_sensor_settings(*command, options->sensor_settings);
  command->add_option("--width", options->width, "Of the object that is to be seen: 60mm")->required();
  command
      ->add_option("--f-number", options->camera.f_number,
                   "Stop down to this; lenses that open less are left out")
      ->check(positive_number());
  command->add_flag("--scaled", options->scaled, "Lenses may be scaled to fit");
  add_distance(*options, *command, "450,550,650");
}

}  // namespace petzval::app
