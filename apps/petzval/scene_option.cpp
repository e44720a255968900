// SPDX-License-Identifier: BSD-3-Clause
#include "scene_option.h"

#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/quantities.h>
#include <petzval/scene/depth_map.h>
#include <petzval/scene/wavelength_list.h>

#include <charconv>
#include <cmath>
#include <string_view>

namespace petzval::app {

namespace {

template <typename Number>
std::optional<Number> whole_text(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

double positive(const std::string& option, const std::string& text, const char* right) {
  const std::optional<double> value = whole_text<double>(text);
  if (!value || !(*value > 0) || std::isinf(*value))
    throw InputError(fmt::format("{} {}: {} would be right", option, text, right));
  return *value;
}

}  // namespace

void SceneChoice::add_to(CLI::App& command, bool positional, bool required) {
  CLI::Option* option = command.add_option(
      positional ? "scene" : "--scene", path_or_name,
      "ISET .mat, spectral .exr, ENVI .hdr, NumPy .npy, a photograph (.png, .jpg, .tif), or a chart's name "
      "(petzval scene list)");
  if (required) option->required();
  command.add_option("--scene-angle", angle, "Full horizontal angle of the scene [degrees]");
  command.add_option("--scene-width", width,
                     "Width of the scene at its distance, in place of an angle: 200mm");
  command.add_option("--scene-tilt", tilt,
                     "Turns a plane scene about its upright middle line, its right side away [degrees]");
  command.add_option("--scene-distance", distance, "Distance from the sensor plane: 1.2m, 250mm or infinity");
  command.add_option("--scene-luminance", luminance,
                     "Mean luminance [cd/m2], of the whole spectrum whatever --wavelengths takes from it");
  command.add_option("--illuminance", illuminance,
                     "Light on the scene, in place of a mean luminance: 500 or 500lx, or of any light 5W/m2");
  command.add_option("--band-width", band_width,
                     "Of every band [nm], as behind filters; without it bands share out the light");
  command.add_option("--scene-size", size, "Samples of a chart: 768x576");
  command.add_option("--wavelengths", wavelengths, "Bands [nm]: 400:10:700, or a list 450,550,650");
  command.add_option(
      "--illuminant", illuminant,
      "Light on a chart, a photograph or reflectances, or in place of a scene's own: D65, A, E, LED-B3, "
      "3200K, 532nm (a line), 850nm/30 (an LED and its width) or a file");
  command
      .add_option("--scene-encoding", encoding,
                  "Numbers of a photograph: auto (its colour profile, else sRGB), srgb or linear")
      ->check(CLI::IsMember({"auto", "srgb", "linear"}));
  command
      .add_option("--scene-projection", projection,
                  "plane, or equirectangular: a panorama of all directions, its middle straight ahead")
      ->check(CLI::IsMember({"plane", "equirectangular"}));
  command.add_option("--scene-yaw", yaw, "Turns the camera to the right within a panorama [degrees]");
  command.add_option("--scene-pitch", pitch, "Tilts it up [degrees]");
  command
      .add_option("--scene-depth", depth,
                  "Depth map [m]: a .npy of rows and columns or an .exr with a channel Z; none: leave the "
                  "scene's own out")
      ->check(CLI::Validator(
          [](const std::string& word) {
            return word.empty() ? std::string("a file's name, or none, would be right") : std::string();
          },
          ""));
  command.add_option("--scene-depth-scale", depth_scale, "Multiplies all depths");
  command
      .add_option(
          "--scene-depth-from", depth_from,
          "Depths count along the axis from the sensor plane (sensor, unless the file says otherwise) or "
          "from the entrance pupil (pupil), or along the line of sight from the latter (range)")
      ->check(CLI::IsMember({"sensor", "pupil", "range"}));
  add_cube_options(command);
}

void SceneChoice::add_cube_options(CLI::App& command) {
  command.add_option("--scene-quantity", quantity, "What the numbers of an ENVI, NumPy or OpenEXR file are")
      ->check(CLI::IsMember({"radiance", "reflectance", "emissivity", "temperature"}));
  command.add_option("--scene-unit", unit, "Of such radiance: W.m^-2.sr^-1.nm^-1, uW/cm2/sr/nm or the like");
  command.add_option("--scene-scale", scale, "Multiplies such numbers before anything else");
  command.add_option("--scene-bands", file_bands,
                     "Wavelengths of such a file that does not say them [nm]: 400:10:700");
  command.add_flag("--scene-negative-zero", negative_is_zero, "Take such numbers below 0 for 0");
  command.add_option("--scene-temperature", temperature, "Of all surfaces, for emissivities [K]");
  command.add_option("--scene-emissivity", emissivity, "Of all surfaces, for a map of temperatures: 0 to 1");
  command.add_option("--scene-background", background, "Temperature of what warm surfaces mirror [K]");
}

SceneOptions SceneChoice::options(SceneOptions defaults) const {
  SceneOptions options = std::move(defaults);
  if (!angle.empty())
    options.horizontal_angle_deg = positive("--scene-angle", angle, "degrees above 0 and below 180");
  if (!width.empty()) {
    options.width_m = parse_distance_m(width, "scene.width_m");
    if (std::isinf(*options.width_m))
      throw InputError("--scene-width infinity: a length such as 200mm would be right");
  }
  if (!tilt.empty()) {
    options.tilt_deg = whole_text<double>(tilt);
    if (!options.tilt_deg) throw InputError(fmt::format("--scene-tilt {}: degrees would be right", tilt));
  }
  if (!distance.empty()) options.distance_m = parse_distance_m(distance, "scene.distance_m");
  if (!luminance.empty())
    options.mean_luminance_cd_m2 = positive("--scene-luminance", luminance, "a positive number of cd/m2");
  take_illuminance(options);
  if (!band_width.empty()) options.band_width_nm = positive("--band-width", band_width, "a number of nm");
  if (!size.empty()) {
    const GridSize samples = parse_grid_size(size, "scene.size");
    options.columns = samples.columns, options.rows = samples.rows;
  }
  if (!wavelengths.empty()) options.wavelengths_nm = parse_wavelengths_nm(wavelengths);
  if (!illuminant.empty()) options.illuminant = illuminant;
  options.depth = depth;
  if (!depth_scale.empty())
    options.depth_scale = positive("--scene-depth-scale", depth_scale, "a positive number");
  if (!depth_from.empty()) options.depth_from = parse_depth_from(depth_from);
  take_panorama(options);
  take_cube(options);
  if (!encoding.empty())
    options.encoding = encoding == "srgb"     ? PhotographEncoding::srgb
                       : encoding == "linear" ? PhotographEncoding::linear
                                              : PhotographEncoding::by_file;
  return options;
}

Scene SceneChoice::read(const Shared& shared) const {
  Scene scene = read();
  print_notes(scene, shared);
  return scene;
}

void SceneChoice::print_notes(const Scene& scene, const Shared& shared) const {
  for (const std::string& text : scene.notes) note(shared, fmt::format("{}: {}", path_or_name, text));
}

void SceneChoice::take_illuminance(SceneOptions& options) const {
  if (illuminance.empty()) return;
  constexpr const char* right = "500, 500lx or 5W/m2";
  std::string_view number = illuminance;
  const auto without = [&](std::string_view unit) {
    const bool ends = number.ends_with(unit);
    if (ends) number.remove_suffix(unit.size());
    return ends;
  };
  const bool watts = without("W/m2") || without("W/m²");
  if (!watts && !without("lux")) without("lx");
  (watts ? options.irradiance_w_m2 : options.illuminance_lx) =
      positive("--illuminance", std::string(number), right);
}

void SceneChoice::take_panorama(SceneOptions& options) const {
  const auto angle_of = [](const char* option, const std::string& text) {
    const std::optional<double> value = text.empty() ? std::optional(0.0) : whole_text<double>(text);
    if (!value || !std::isfinite(*value))
      throw InputError(fmt::format("{} {}: an angle in degrees would be right", option, text));
    return *value;
  };
  if (is_panorama()) {
    options.panorama = {angle_of("--scene-yaw", yaw), angle_of("--scene-pitch", pitch)};
  } else if (!yaw.empty() || !pitch.empty()) {
    throw InputError("--scene-yaw and --scene-pitch are for --scene-projection equirectangular");
  }
}

void SceneChoice::take_cube(SceneOptions& options) const {
  if (!quantity.empty()) options.quantity = parse_scene_quantity(quantity);
  options.radiance_unit = unit;
  options.negative_is_zero = negative_is_zero;
  if (!scale.empty()) options.scale = positive("--scene-scale", scale, "a positive number");
  if (!file_bands.empty()) options.file_bands_nm = parse_wavelengths_nm(file_bands);
  if (!temperature.empty())
    options.thermal.temperature_k = positive("--scene-temperature", temperature, "kelvins above 0");
  if (!background.empty())
    options.thermal.background_k = positive("--scene-background", background, "kelvins above 0");
  if (!emissivity.empty())
    options.thermal.emissivity = positive("--scene-emissivity", emissivity, "a number above 0, up to 1,");
}

}  // namespace petzval::app
