// SPDX-License-Identifier: BSD-3-Clause
// petzval sense: irradiance onto a sensor, a raw image out.
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/file_extension.h>
#include <petzval/base/staged_files.h>
#include <petzval/image/formats/irradiance.h>
#include <petzval/isp/raw_output.h>
#include <petzval/scene/wavelength_list.h>
#include <petzval/sensor/formats/dng.h>
#include <petzval/sensor/raw_file.h>
#include <petzval/simulate/outputs.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "command.h"
#include "output_option.h"
#include "raw_levels.h"
#include "sense_option.h"
#include "sensor_option.h"

namespace petzval::app {

namespace {

struct SenseCommand {
  std::string irradiance, sensor, wavelengths;
  std::vector<std::string> sensor_settings;
  SenseChoice choice;
  std::vector<std::string> outputs;
};

nlohmann::ordered_json summary_json(const RawImage& raw, const std::vector<std::string>& outputs) {
  return {{"columns", raw.columns},
          {"rows_of_pixels", raw.rows},
          {"sensor", raw.sensor_name},
          {"mosaic", mosaic_text(raw.mosaic, raw.channels)},
          {"exposure_s", raw.exposure_s},
          {"iso", raw.iso},
          {"black_level_dn", raw.black_level},
          {"white_level_dn", raw.white_level},
          {"dn_per_e", raw.dn_per_e},
          {"read_noise_e", raw.read_noise_e},
          {"as_shot_neutral", raw.as_shot_neutral},
          {"rows", levels_json(raw)},
          {"outputs", outputs}};
}

void print_summary(const RawImage& raw) {
  fmt::print("{} x {} pixels, {}, {}\n", raw.columns, raw.rows, mosaic_text(raw.mosaic, raw.channels),
             raw.sensor_name);
  fmt::print("  exposure  {:.4g} s, ISO {:.0f}\n", raw.exposure_s, raw.iso);
  fmt::print("  levels    black {:g} DN, white {:g} DN, {:.4g} DN per electron, read noise {:.3g} e\n",
             raw.black_level, raw.white_level, raw.dn_per_e, raw.read_noise_e);
  print_levels(raw);
}

/// Of bare numbers: pixels are those of the sensor. \throws InputError for wavelengths of a file that says
/// its own.
BareIrradiance bare_irradiance(const SenseCommand& command, const Sensor& sensor) {
  const bool bare = extension_of(command.irradiance) == ".npy";
  if (!bare && !command.wavelengths.empty())
    throw InputError(command.irradiance, "says its wavelengths; --wavelengths is for .npy");
  if (bare && command.wavelengths.empty())
    throw InputError(
        command.irradiance,
        "a .npy file does not say its wavelengths; --wavelengths 400:10:700 would be right with it");
  BareIrradiance numbers;
  if (bare) numbers.wavelengths_nm = parse_wavelengths_nm(command.wavelengths);
  numbers.pitch_um = sensor.geometry.pitch_um;
  numbers.aperture = sensor.photosite.is_plain() ? PixelAperture::box : PixelAperture::photosite;
  numbers.photosite = sensor.photosite.text();
  return numbers;
}

void sense(const SenseCommand& command, const Shared& shared) {
  for (const std::string& path : command.outputs) require_extension(path, raw_extensions(), "a raw image");
  StagedFiles files;
  std::vector<std::string> staged;
  for (const std::string& path : command.outputs) staged.push_back(files.stage(path));
  const Sensor sensor = read_sensor(command.sensor, command.sensor_settings);
  sensor.require_electronics();
  const RawImage raw = expose(read_irradiance(command.irradiance, bare_irradiance(command, sensor)), sensor,
                              command.choice.options(), context_of(shared));
  for (const std::string& path : staged) write_raw_output(path, raw);
  if (const std::string note = mosaic_note(raw);
      !note.empty() && std::ranges::any_of(command.outputs, is_raw_name))
    send_note(context_of(shared), note);
  files.commit();
  if (shared.json) return fmt::print("{}\n", summary_json(raw, command.outputs).dump(2));
  if (!shared.quiet) print_summary(raw);
}

}  // namespace

void add_sense_command(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<SenseCommand>();
  CLI::App* command = add_command(app, shared, "sense", "Expose a sensor to an irradiance: a raw image",
                                  "petzval sense light.exr --sensor third-inch-1280x960 -o raw.dng", true,
                                  [options, &shared] { sense(*options, shared); });
  command
      ->add_option("irradiance", options->irradiance,
                   "Spectral irradiance as petzval image writes it: .exr, .npz, or .npy with --wavelengths")
      ->required();
  command->add_option("--wavelengths", options->wavelengths,
                      "Of the bands of a .npy [nm]: 400:10:700, or a list; its pixels are the sensor's");
  command->add_option("--sensor", options->sensor, "A sensor file or the name of a bundled one")->required();
  add_sensor_settings(*command, options->sensor_settings);
  options->choice.add_to(*command);
  command
      ->add_option("-o,--output", options->outputs, "RAW.dng, .tif, .npy or .exr; may be given several times")
      ->check(output_file())
      ->required()
      ->allow_extra_args(false);
}

}  // namespace petzval::app
