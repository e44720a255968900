// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/error.h>
#include <petzval/base/file_extension.h>
#include <petzval/image/formats/irradiance.h>
#include <petzval/image/picture.h>
#include <petzval/isp/display_picture.h>
#include <petzval/isp/raw_output.h>
#include <petzval/sensor/formats/dng.h>
#include <petzval/simulate/outputs.h>

#include <algorithm>
#include <utility>

namespace petzval {

namespace {

bool is_irradiance_name(const std::string& path) {
  const std::string extension = extension_of(path);
  return extension == ".exr" || extension == ".npy" || extension == ".npz";
}

/// A few pixels of light that every channel sees, as image() would make it.
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

/// What the options are refused for.
void try_out(const OutputOptions& options, const Sensor& sensor, bool raw_file, bool pictures) {
  const RawImage raw = expose(probe_light(sensor), sensor, options.expose);
  if (raw_file && fits_dng(raw)) dng_bytes(raw, "a raw file");
  if (raw_file && !fits_dng(raw))
    throw InputError(
        fmt::format("DNG has no numbers for the channels {}; an .exr of the light would be right, to be "
                    "sensed from there",
                    fmt::join(raw.channels, ", ")));
  if (!pictures) return;
  Development development = options.development;
  development.flat.reset();  // is as large as the sensor
  develop(raw, development);
}

/// The white of the scene, if its light in these bands can be taken for white at all: two or three narrow
/// bands cannot.
std::optional<Spectrum> usable_white(const SpectralImage& light, const std::optional<Spectrum>& white,
                                     const Context& context) {
  const SpectralImage one_pixel(1, 1, light.wavelengths_nm(), light.pitch_um());
  PictureOptions options;
  options.scene_white = white;
  try {
    const PictureRenderer possible(one_pixel, options);
    return white;
  } catch (const InputError& error) {
    send_note(context, fmt::format("colours are shown as they fall on the sensor, not adapted to white: {}",
                                   error.what()));
    return {};
  }
}

/// What saturates a sensor of ISO 100 (H = 78/S lx·s, ISO 12232) shows as white.
void expose_picture(const SpectralImage& light, const ExposeOptions& options, PictureOptions& shown) {
  shown.compensation_ev = options.compensation_ev;
  if (options.exposure.kind == Exposure::Kind::automatic) return;
  constexpr double saturation_lx_s = 78.0 / 100;
  double seconds = options.exposure.value;
  if (options.exposure.kind == Exposure::Kind::exposure_value) {
    const double n = light.lens ? light.lens->f_number : 0;
    if (!(n > 0))
      throw InputError(
          "`exposure` with an exposure value needs an f-number, and this camera has none; a time would be "
          "right");
    seconds = exposure_of_ev_s(options.exposure.value, n);
  }
  if (!(seconds > 0)) throw InputError("`exposure` 0: a picture needs a time above 0");
  shown.exposure = PictureOptions::Exposure::fixed;
  shown.white_level = saturation_lx_s / seconds;
}

/// The light as a viewer would see it.
void show(const SpectralImage& light, const std::string& path, const OutputOptions& options,
          StagedFiles& files, const Context& context) {
  PictureOptions shown = options.shown;
  expose_picture(light, options.expose, shown);
  if (!shown.scene_white) shown.scene_white = light.illuminant;
  if (shown.scene_white) shown.scene_white = usable_white(light, shown.scene_white, context);
  send_note(context,
            fmt::format("{}: {}", path, write_picture(files.stage(path), light, shown, options.bits)));
}

/// The picture with frames over it, of pixels of a light of that many columns (a sensor may bin).
Picture framed(Picture picture, const std::vector<PictureFrame>& frames, int columns) {
  const auto to_picture = [&](int at) { return at * picture.planes.columns / columns; };
  for (const PictureFrame& each : frames) {
    const PictureFrame scaled{to_picture(each.left), to_picture(each.top), to_picture(each.right),
                              to_picture(each.bottom)};
    for (int row = 0; row < picture.planes.rows; ++row)
      for (int column = 0; column < picture.planes.columns; ++column)
        if (scaled.is_on_rim(column, row))
          for (std::size_t channel = 0; channel < picture.planes.values.size(); ++channel)
            picture.planes.values[channel][static_cast<std::size_t>(row) * picture.planes.columns + column] =
                frame_colour[std::min<std::size_t>(channel, 2)];
  }
  return picture;
}

/// Raw files and developed pictures: what expose() and develop() make of the same light, byte for byte.
Outputs shoot(const SpectralImage& light, const std::vector<std::string>& raws,
              const std::vector<std::string>& pictures, const Sensor& sensor, const OutputOptions& options,
              StagedFiles& files, const Context& context) {
  Outputs made{expose(light, sensor, options.expose, context), {}};
  for (const std::string& path : raws) write_raw_output(files.stage(path), *made.raw);
  if (const std::string note = mosaic_note(*made.raw); !raws.empty() && !note.empty())
    send_note(context, note);
  if (pictures.empty()) return made;

  // A DNG rounds what is not an integer; what is developed is what one would read.
  const std::string name = "the raw image";
  const RawImage stored = fits_dng(*made.raw) ? parse_dng(dng_bytes(*made.raw, name), name) : *made.raw;
  const DevelopStep write_step = [&](const std::string& step, const Planes& planes) {
    for (const auto& [wanted, path] : options.step_files)
      if (wanted == step)
        write_display_picture(files.stage(path), planes, options.development.options.space, 16,
                              fmt::format("step {} of development", step));
  };
  made.picture =
      develop(stored, options.development, context, options.step_files.empty() ? DevelopStep() : write_step);
  std::optional<Picture> altered;
  if (!options.shown.frames.empty()) altered = framed(*made.picture, options.shown.frames, light.columns());
  if (!options.shown.insets.empty())
    altered = with_insets(altered ? *altered : *made.picture, options.shown.insets);
  for (const std::string& path : pictures)
    write_picture(files.stage(path), altered ? *altered : *made.picture, options.bits);
  return made;
}

}  // namespace

bool is_raw_name(const std::string& path) {
  return extension_of(path) == ".dng";
}

bool is_picture_name(const std::string& path) {
  const std::string extension = extension_of(path);
  return extension == ".png" || extension == ".jpg" || extension == ".jpeg" || extension == ".tif" ||
         extension == ".tiff";
}

bool develops(const OutputOptions& options, const std::optional<Sensor>& sensor) {
  return options.picture == OutputOptions::Shows::developed ||
         (options.picture == OutputOptions::Shows::automatic && sensor && sensor->electronics);
}

void check_outputs(const std::vector<std::string>& paths, const std::optional<Sensor>& sensor,
                   const OutputOptions& options) {
  const bool develop_pictures = develops(options, sensor);
  // Their places, before there is a picture.
  if (sensor) InsetSheet(sensor->geometry.columns, sensor->geometry.rows, options.shown.insets);
  bool raw = false, pictures = false;
  for (const std::string& path : paths) {
    if (!is_raw_name(path) && !is_picture_name(path) && !is_irradiance_name(path))
      throw InputError(
          path,
          "irradiance is written as .exr, .npy or .npz, a raw file as .dng, a picture as .png, .jpg or .tif");
    raw = raw || is_raw_name(path);
    pictures = pictures || is_picture_name(path);
    if (!develop_pictures && is_picture_name(path) && extension_of(path) != ".png")
      throw InputError(
          path,
          "a .tif or .jpg is a developed picture, and needs `sensor` with a sensor that turns light "
          "into numbers; the light itself is shown by a .png");
  }
  if (options.picture == OutputOptions::Shows::developed && !pictures)
    throw InputError(
        "`picture` developed has no effect without a picture among the outputs; a .png would be one");
  if (!raw && !(pictures && develop_pictures)) return;
  if (!sensor)
    throw InputError(
        "a raw file and a developed picture need `sensor` with a sensor that turns light into numbers "
        "(third-inch-1280x960, for example)");
  sensor->require_electronics();
  try_out(options, *sensor, raw, pictures && develop_pictures);
}

Outputs write_outputs(SpectralImage light, const std::vector<std::string>& paths,
                      const std::optional<Sensor>& sensor, const OutputOptions& options, StagedFiles& files,
                      const Context& context) {
  std::vector<std::string> of_light, raws, pictures;
  for (const std::string& path : paths) {
    if (is_raw_name(path))
      raws.push_back(path);
    else if (!is_picture_name(path))
      of_light.push_back(path);
    else if (develops(options, sensor))
      pictures.push_back(path);
    else
      show(light, path, options, files, context);
  }
  Outputs made;
  if (!raws.empty() || !pictures.empty())
    made = shoot(light, raws, pictures, *sensor, options, files, context);
  // Whole images come last: the last of them may use the room that the light takes.
  for (std::size_t i = 0; i < of_light.size(); ++i) {
    const std::string staged = files.stage(of_light[i]);
    if (i + 1 == of_light.size()) {
      write_irradiance(staged, std::move(light), options.layers);
      break;
    }
    write_irradiance(staged, light, options.layers);
  }
  return made;
}

Outputs write_outputs(SpectralImage light, const std::vector<std::string>& paths,
                      const std::optional<Sensor>& sensor, const OutputOptions& options,
                      const Context& context) {
  check_outputs(paths, sensor, options);
  StagedFiles files;
  Outputs made = write_outputs(std::move(light), paths, sensor, options, files, context);
  files.commit();
  return made;
}

}  // namespace petzval
