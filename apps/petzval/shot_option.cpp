// SPDX-License-Identifier: BSD-3-Clause
#include "shot_option.h"

#include <fmt/format.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/file_extension.h>
#include <petzval/isp/display_picture.h>
#include <petzval/sensor/formats/dng.h>

#include <algorithm>

namespace petzval::app {

namespace {

constexpr const char *exposing = "Exposure of the sensor", *developing = "Development of the picture";

bool ends_in(const std::string& path, const std::vector<std::string>& extensions) {
  const std::string extension = extension_of(path);
  return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}
bool is_raw(const std::string& path) {
  return ends_in(path, {".dng"});
}
bool is_picture(const std::string& path) {
  return ends_in(path, {".png", ".tif", ".tiff"});
}

/// The first option of a group that was given, or nothing.
std::string given_option(const CLI::App& command, const char* group) {
  for (const CLI::Option* option : command.get_options())
    if (option->get_group() == group && option->count() > 0) return option->get_name();
  return "";
}

/// Options that `add` adds stand under a heading of their own in the help.
template <typename Add>
void add_group(CLI::App& command, const char* group, const Add& add) {
  const std::string before = command.option_defaults()->get_group();
  command.option_defaults()->group(group);
  add();
  command.option_defaults()->group(before);
}

/// A few pixels of light that every channel sees, as `image` would make it.
SpectralImage probe_light(const Sensor& sensor) {
  std::vector<double> nm;
  for (const SensorChannel& channel : sensor.electronics->channels)
    nm.insert(nm.end(), channel.quantum_efficiency.wavelengths_nm().begin(),
              channel.quantum_efficiency.wavelengths_nm().end());
  std::sort(nm.begin(), nm.end());
  nm.erase(std::unique(nm.begin(), nm.end()), nm.end());
  constexpr int side = 8;
  SpectralImage light(std::min(side, sensor.geometry.columns), std::min(side, sensor.geometry.rows), nm,
                      sensor.geometry.pitch_um,
                      sensor.photosite.is_plain() ? PixelAperture::box : PixelAperture::photosite);
  light.photosite = sensor.photosite.text();
  light.lens = LensFacts{"", 1, 1, -1};
  for (int band = 0; band < light.bands(); ++band) std::ranges::fill(light.band(band), 1e-3F);
  return light;
}

/// What the options are refused for, on a few pixels: before minutes have gone into the light.
void try_out(const ShotChoice& choice, const Sensor& sensor, bool raw_file, bool pictures) {
  Shared silent;
  silent.quiet = true;
  const RawImage raw = choice.sense.expose(probe_light(sensor), sensor, silent);
  if (raw_file && fits_dng(raw)) dng_bytes(raw, "a raw file");
  if (raw_file && !fits_dng(raw))
    throw InputError(
        fmt::format("DNG has no numbers for the channels {}; an .exr for petzval sense would be right",
                    fmt::join(raw.channels, ", ")));
  if (!pictures) return;
  DevelopChoice develop = choice.develop;
  develop.flat.clear();  // is as large as the sensor
  develop.steps.clear();
  DevelopReport report;
  develop.develop(raw, report, {});
}

}  // namespace

void ShotChoice::add_to(CLI::App& command) {
  command
      .add_option("--picture", picture,
                  "What a picture shows: what the sensor makes of the light (developed), or the light itself "
                  "(irradiance); auto: developed, if the sensor turns light into numbers")
      ->check(CLI::IsMember({"auto", "developed", "irradiance"}))
      ->capture_default_str();
  add_group(command, exposing, [&] { sense.add_to(command, true); });
  add_group(command, developing, [&] { develop.add_to(command, true); });
}

bool ShotChoice::develops(const std::optional<Sensor>& sensor) const {
  return picture == "developed" || (picture == "auto" && sensor && sensor->electronics);
}

void ShotChoice::check(const std::optional<Sensor>& sensor, const std::vector<std::string>& outputs,
                       const CLI::App& command) const {
  const bool develop_pictures = develops(sensor);
  bool raw = false, pictures = false;
  for (const std::string& path : outputs) {
    raw = raw || is_raw(path);
    pictures = pictures || is_picture(path);
    if (!develop_pictures && ends_in(path, {".tif", ".tiff"}))
      throw InputError(path,
                       "a .tif is a developed picture, and needs --sensor with a sensor that turns light "
                       "into numbers; the light itself is shown by a .png");
  }
  if (picture == "developed" && !pictures)
    throw InputError("--picture developed has no effect without a picture among the outputs (-o shot.png)");
  if (raw || (pictures && develop_pictures)) {
    if (!sensor)
      throw InputError(
          "a raw file and a developed picture need --sensor with a sensor that turns light into numbers "
          "(third-inch-1280x960, for example)");
    sensor->require_electronics();
    try_out(*this, *sensor, raw, pictures && develop_pictures);
  } else if (const std::string option = given_option(command, exposing); !option.empty()) {
    throw InputError(fmt::format(
        "{} has no effect: no raw file (-o shot.dng) and no developed picture is asked for", option));
  }
  if (!(pictures && develop_pictures))
    if (const std::string option = given_option(command, developing); !option.empty())
      throw InputError(fmt::format("{} has no effect: no developed picture is asked for", option));
}

std::optional<Shot> ShotChoice::shoot(const SpectralImage& light, const std::optional<Sensor>& sensor,
                                      const std::vector<std::string>& outputs, StagedFiles& files,
                                      const Shared& shared) const {
  std::vector<std::string> raws, pictures;
  for (const std::string& path : outputs) {
    if (is_raw(path)) raws.push_back(path);
    if (is_picture(path) && develops(sensor)) pictures.push_back(path);
  }
  if (raws.empty() && pictures.empty()) return {};
  Shot shot{sense.expose(light, *sensor, shared), {}};
  for (const std::string& path : raws) write_dng(files.stage(path), shot.raw);
  if (pictures.empty()) return shot;

  // A DNG rounds what is not an integer; what is developed is what one would read.
  const std::string name = "the raw image";
  const RawImage stored = fits_dng(shot.raw) ? parse_dng(dng_bytes(shot.raw, name), name) : shot.raw;
  const Planes planes = develop.develop(stored, shot.development.emplace(),
                                        [&](const std::string& path) { return files.stage(path); });
  const std::string provenance = fmt::format("petzval {} develop: {}", version(), stored.provenance);
  for (const std::string& path : pictures)
    write_display_picture(files.stage(path), planes, display_space(develop.space), bits, provenance);
  return shot;
}

}  // namespace petzval::app
