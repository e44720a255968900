// SPDX-License-Identifier: BSD-3-Clause
#include "render_option.h"

#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/number_text.h>
#include <petzval/base/quantities.h>
#include <petzval/base/text_lines.h>
#include <petzval/scene/wavelength_list.h>

#include <cmath>
#include <string_view>

namespace petzval::app {

namespace {

/// --focus on what a pixel sees.
constexpr std::string_view by_pixel = "pixel@";

void add_camera_options(RenderChoice& choice, CLI::App& command) {
  RenderRequest& request = choice.request;
  choice.camera.add_lens(command, false, false);
  choice.camera.losses.add_to(command);
  command.add_option("--film-diagonal", request.film_diagonal_mm, "Of the film, corner to corner [mm]");
  command.add_option("--aperture-diameter", request.aperture_diameter_mm, "Of the stop [mm]");
  command.add_option("--f-number", choice.camera.f_number, "Stop down to this paraxial f-number at infinity")
      ->check(positive_number());
  choice.camera.add_blades(command);
  choice.camera.add_apertures(command);
  command.add_flag("--diffraction", request.diffraction,
                   "Let light of what is about in focus land as waves do, by the lens's diffraction PSFs");
  command.add_flag("--pinhole", request.pinhole, "The scene's perspective through a pinhole, for comparison");
  choice.camera.add_sensor(
      command,
      "Sensor, by name or file, or 768x576@6.25 (pixels @ pitch in um): its size, pitch, photosite "
      "and optical low-pass filter in place of the scene's film");
  command.add_option("--size", choice.size,
                     "Of the picture in pixels, as 400x300; of the middle of a --sensor");
  command
      .add_option(
          "--sampling", choice.sampling,
          "Directions from a film point: inside of the pupil, or over the disk of the last surface (2006)")
      ->check(CLI::IsMember({"exit-pupil", "rear-disk"}))
      ->capture_default_str();
  command
      .add_option("--camera-at", choice.camera_at,
                  "X,Y,Z: where the camera stands [scene units]; default: as in the scene")
      ->type_name("X,Y,Z");
  command
      .add_option("--look-at", choice.look_at,
                  "X,Y,Z: what is in the middle of the picture [scene units]; default: as in the scene, with "
                  "--camera-at the middle of the scene")
      ->type_name("X,Y,Z");
  command
      .add_option("--camera-move", choice.camera_move,
                  "X,Y,Z: how the camera moves while its shutter is open [scene units]")
      ->type_name("X,Y,Z");
  command
      .add_option("--look-move", choice.look_move,
                  "X,Y,Z: how what is in the middle of the picture moves meanwhile; alone, the camera turns")
      ->type_name("X,Y,Z");
  command
      .add_option("--rolling-shutter", request.rolling_shutter,
                  "Share of that time by which the last row begins after the first; 0: all at once")
      ->check(CLI::Range(0.0, 0.999999))
      ->capture_default_str();
  command
      .add_option("--field-of-view", request.field_of_view_deg,
                  "Across the picture, of a camera without a lens [deg]")
      ->check(positive_number());
  command.add_option("--camera-origin", choice.camera_origin, "What stands where the scene puts its camera")
      ->check(CLI::IsMember({"film", "front"}))
      ->capture_default_str();
}

void add_scene_options(RenderChoice& choice, CLI::App& command) {
  RenderRequest& request = choice.request;
  command.add_option("--wavelengths", choice.wavelengths, "FROM:STEP:TO or a list [nm]");
  command.add_option("--scene-unit", request.scene_unit_mm, "Length of the scene's unit [mm]")
      ->capture_default_str();
  command
      .add_option("--max-depth", request.max_depth,
                  "Times that light is scattered at most; default: the scene's, or 5")
      ->check(CLI::Range(1, 10000));
  command
      .add_option(
          "--near", request.near_distance,
          "Surfaces nearer than this to the camera's place, along its axis, are not seen [scene units]")
      ->check(positive_number());
  command.add_option("--far", request.far_distance, "Nor surfaces beyond this")->check(positive_number());
  command
      .add_option("--sky", request.sky_cd_m2,
                  "White light from all around of this luminance, added to that of the scene [cd/m2]")
      ->check(positive_number());
  command
      .add_option(
          "--scene-time", request.scene_time,
          "What moves in the scene stands where it is at this time, in the unit of its TransformTimes")
      ->check(finite_number())
      ->capture_default_str();
  command.add_option("--light-scale", request.light_scale, "All lights of the scene this much stronger")
      ->check(positive_number())
      ->capture_default_str();
  command
      .add_option_function<std::vector<std::string>>(
          "--light",
          [&request](const std::vector<std::string>& changes) {
            for (const std::string& text : changes)
              request.light_changes.push_back(render::parse_light_change(text));
          },
          "One light stronger, turned [degrees] or coloured [K]: scale@0=2, turn_deg@0=30, kelvin@1=3200; "
          "sources are counted from 0, then surfaces that shine (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
  command.add_flag("--skip-unsupported", request.skip_unsupported,
                   "Leave out what the scene has and Petzval has not, instead of refusing the scene");
  command.add_flag(
      "--absolute-spectra", request.absolute_spectra,
      "Spectra of lights are radiances [W/(m2 sr nm)] as they stand, not scaled as pbrt-v4 scales them");
}

}  // namespace

void AutofocusChoice::add_to(CLI::App& command) {
  command
      .add_option("--zone", zones,
                  "Focus by itself on a zone: left,right,top,bottom in fractions of the film (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
  command
      .add_option("--focus-measure", measure, "Sum-modified-Laplacian (sml), gradient or laplacian energy")
      ->check(CLI::IsMember({"sml", "gradient", "laplacian"}))
      ->capture_default_str();
  command.add_option("--focus-step", options.measure.step, "Pixels between the points of its differences")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command
      .add_option("--focus-threshold", options.measure.threshold,
                  "Modified Laplacians below this do not count")
      ->capture_default_str();
  command
      .add_option(
          "--focus-search", search,
          "Coarse places then Brent's method, the golden sections of 2006, or all places evenly over the "
          "range (scan)")
      ->check(CLI::IsMember({"brent", "golden-2006", "scan"}))
      ->capture_default_str();
  command
      .add_option(
          "--focus-spp", options.samples_per_pixel,
          "Camera paths a pixel of the zones to begin with; up to 16 times as many where noise asks for them")
      ->check(CLI::Range(2, 1 << 20))
      ->capture_default_str();
  command.add_option("--focus-from", options.from_mm,
                     "Film distances searched, from [mm]; default: a little before infinity is sharp");
  command.add_option("--focus-to", options.to_mm,
                     "Film distances searched, to [mm]; default: 0.15 focal lengths beyond that of infinity");
  command
      .add_option("--focus-depth", options.depth_mm,
                  "Depth of focus [mm], the scale of the search; default: f-number times pixel")
      ->check(positive_number());
  command.add_option("--focus-evaluations", options.most_evaluations,
                     "At most so many places; default: 12, of golden-2006 as many as it takes");
}

AutofocusOptions AutofocusChoice::read() const {
  AutofocusOptions result = options;
  result.measure.measure = focus_measure_of(measure);
  result.search = autofocus_search_of(search);
  if (!zones_file.empty()) result.zones = read_focus_zones(zones_file);
  for (const std::string& zone : zones) {
    const std::vector<FocusZone> one = parse_focus_zones(zone, "--zone " + zone);
    result.zones.insert(result.zones.end(), one.begin(), one.end());
  }
  return result;
}

void RenderChoice::add_to(CLI::App& command) {
  camera.usual_focus = Focus::automatic();
  command.add_option(
      "scene", request.scene,
      "Scene in the text format of pbrt-v4 or in glTF 2.0 (.gltf, .glb), or the name of a bundled one");
  add_camera_options(*this, command);
  add_scene_options(*this, command);
  autofocus.add_to(command);
}

namespace {

/// So many numbers with commas between them. \throws InputError in the words of the option.
template <std::size_t count>
std::array<double, count> numbers_of(const std::string& text, const std::string& option,
                                     const std::string& right) {
  std::array<double, count> numbers{};
  std::size_t from = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t to = i + 1 < count ? text.find(',', from) : text.size();
    const auto number = to == text.npos ? std::nullopt : parse_number(text.substr(from, to - from));
    if (!number || !std::isfinite(*number))
      throw InputError(fmt::format("{} {}: {} would be right", option, quotable(text), right));
    numbers[i] = *number, from = to + 1;
  }
  return numbers;
}

std::optional<std::array<double, 3>> place_of(const std::string& text, const char* option) {
  if (text.empty()) return {};
  return numbers_of<3>(text, option, "three numbers as in 0,1.5,-2");
}

}  // namespace

RenderRequest RenderChoice::read(const Shared& shared) const {
  if (request.pinhole && !camera.lens.path_or_name.empty())
    throw InputError("--pinhole and --lens exclude each other");
  RenderRequest result = request;
  CameraChoice seen = camera;
  if (seen.focus.starts_with(by_pixel)) {
    result.focus_pixel = numbers_of<2>(seen.focus.substr(by_pixel.size()), "--focus " + std::string(by_pixel),
                                       "a column and a row as in pixel@120,80");
    seen.focus.clear();
  }
  result.camera = seen.camera(shared);
  result.camera_at = place_of(camera_at, "--camera-at");
  result.look_at = place_of(look_at, "--look-at");
  result.camera_move = place_of(camera_move, "--camera-move");
  result.look_move = place_of(look_move, "--look-move");
  if (camera.lens.path_or_name.empty()) {
    // The scene may have a lens.
    result.camera.blades = camera.blades.of_unknown_lens();
    result.camera.losses = camera.losses.read();
  }
  if (!size.empty()) {
    const GridSize pixels = parse_grid_size(size, "size");
    result.columns = pixels.columns, result.rows = pixels.rows;
  }
  if (!wavelengths.empty()) result.wavelengths_nm = parse_wavelengths_nm(wavelengths);
  if (sampling == "rear-disk") result.sampling = RenderRequest::Sampling::rear_disk;
  if (camera_origin == "front") result.camera_origin = RenderRequest::Origin::front;
  result.autofocus = autofocus.read();
  return result;
}

}  // namespace petzval::app
