// SPDX-License-Identifier: BSD-3-Clause
#include "camera_option.h"

#include <fmt/format.h>
#include <petzval/base/error.h>

#include "sensor_option.h"

namespace petzval::app {

void CameraChoice::add_lens(CLI::App& command, bool positional, bool required) {
  lens.add_to(command, positional, required);
}

void CameraChoice::add_stop_and_focus(CLI::App& command, const Focus& usual) {
  usual_focus = usual;
  command.add_option("--f-number", f_number, "Stop down to this paraxial f-number at infinity")
      ->check(positive_number());
  command.add_option(
      "--focus", focus,
      fmt::format("Where the sensor stands: auto (sharp where the scene is), design (as in the "
                  "prescription), infinity, an object distance from the sensor (1.2m, 250mm), "
                  "paraxial, best-spot, best-mtf@CYCLES_PER_MM, or these of an object there "
                  "(250mm+best-spot); default: {}",
                  usual.text()));
  add_focus_corrections(command);
}

void CameraChoice::add_focus_corrections(CLI::App& command) {
  command
      .add_option("--focus-wavelength", focus_wavelength_nm,
                  "What distances are focused for [nm]; default: the lens's reference wavelength, or the "
                  "middle of --wavelengths where it lies outside of them")
      ->check(positive_number());
  command.add_option("--defocus", defocus_mm, "The sensor away from the lens, after focusing [mm]")
      ->check(finite_number());
}

void CameraChoice::add_positions(CLI::App& command) {
  command
      .add_option("--image-distance", image_distance_mm,
                  "Put the sensor this far behind the last surface [mm]")
      ->check(positive_number());
  command.add_option("--move-lens", move_lens_mm,
                     "Move the whole lens towards the object [mm]; object and sensor stay");
}

void CameraChoice::add_blades(CLI::App& command) {
  blades.add_to(command);
}

void CameraChoice::add_field_azimuth(CLI::App& command) {
  command
      .add_option(
          "--field-azimuth", field_azimuth_deg,
          "Of the fields about the axis, from the top of the film anticlockwise as seen from there [deg]: "
          "for a stop of blades, or a lens with poses")
      ->check(finite_number());
}

void CameraChoice::add_apertures(CLI::App& command) {
  command
      .add_option_function<std::string>(
          "--apertures",
          [this](const std::string& choice) {
            if (choice == "from-fields") apertures = Camera::Apertures::from_fields;
          },
          "Clear apertures that the file leaves out: unbounded (file), or what the lens's fields need "
          "(from-fields)")
      ->check(CLI::IsMember({"file", "from-fields"}));
  command.add_flag_callback(
      "--ignore-apertures", [this] { apertures = Camera::Apertures::ignored; },
      "Let nothing but the stop clip the rays");
}

void CameraChoice::add_sensor(CLI::App& command, const std::string& meaning) {
  command.add_option("--sensor", sensor, meaning);
  add_sensor_settings(command, sensor_settings);
}

std::vector<std::string> CameraChoice::given_lens_options() const {
  std::vector<std::string> names;
  const auto add = [&](bool given, const char* name) {
    if (given) names.emplace_back(name);
  };
  add(f_number.has_value(), "--f-number");
  add(!focus.empty(), "--focus");
  add(focus_wavelength_nm.has_value(), "--focus-wavelength");
  add(defocus_mm != 0, "--defocus");
  for (std::string& setting : lens.given_settings()) names.push_back(std::move(setting));
  add(apertures == Camera::Apertures::from_fields, "--apertures");
  add(apertures == Camera::Apertures::ignored, "--ignore-apertures");
  add(image_distance_mm.has_value(), "--image-distance");
  add(move_lens_mm.has_value(), "--move-lens");
  add(blades.count || blades.rotation_deg, "--blades");
  add(losses.any(), "--fresnel, --coating and --absorption");
  return names;
}

void CameraChoice::add_to(CLI::App& command) {
  add_stop_and_focus(command, Focus::design());
  add_positions(command);
  add_blades(command);
  add_field_azimuth(command);
}

Camera CameraChoice::settings(const Lens& of) const {
  Camera camera;
  camera.lens = of;
  camera.focus = focus.empty() ? usual_focus : Focus::parse(focus);
  camera.f_number = f_number;
  camera.image_distance_mm = image_distance_mm;
  camera.focus_wavelength_nm = focus_wavelength_nm;
  camera.defocus_mm = defocus_mm;
  camera.move_lens_mm = move_lens_mm.value_or(0);
  camera.apertures = apertures;
  if (of.surfaces.empty()) return camera;
  camera.blades = blades.blades(of);
  return camera;
}

Camera CameraChoice::camera(const Shared& shared) const {
  if (sensor.empty() && !sensor_settings.empty())
    throw InputError("--sensor-set alters the --sensor, and there is none");
  const Lens read = lens.path_or_name.empty() ? Lens() : lens.read(shared);
  Camera camera = settings(read);
  if (!read.surfaces.empty()) camera.losses = losses.losses(read, shared);
  if (!sensor.empty()) camera.sensor = read_sensor(sensor, sensor_settings);
  return camera;
}

Lens CameraChoice::used(const Lens& of, const std::optional<FieldTableRequest>& request,
                        const Shared& shared) const {
  Camera camera = settings(of);
  camera.apertures = Camera::Apertures::ignored;  // the caller has seen to them
  std::optional<FieldTableRequest> at = request;
  if (at) at->azimuth_deg = field_azimuth_deg;
  const Context context = context_of(shared);
  return petzval::focus(mounted_lens(camera, context), camera.focus, at, context, camera.defocus_mm);
}

}  // namespace petzval::app
