// SPDX-License-Identifier: BSD-3-Clause
#include "render_option.h"

#include <fmt/format.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/colour/observer.h>
#include <petzval/render/gltf/gltf_scene.h>
#include <petzval/render/pbrt/entity_maker.h>
#include <petzval/scene/wavelength_list.h>

#include <cstdio>

namespace petzval::app {

namespace {

/// "400x300" as two numbers.
void parse_size(const std::string& text, render::CameraChoice& choice) {
  int columns = 0, rows = 0;
  char end = 0;
  if (std::sscanf(text.c_str(), "%dx%d%c", &columns, &rows, &end) != 2 || columns < 1 || rows < 1)
    throw InputError(fmt::format("--size {}: WIDTHxHEIGHT in pixels would be right, as 400x300", text));
  choice.columns = columns, choice.rows = rows;
}

render::CameraChoice camera_choice(const RenderChoice& choice, const Shared& shared) {
  render::CameraChoice camera;
  if (!choice.lens.path_or_name.empty()) {
    if (choice.pinhole) throw InputError("--pinhole and --lens exclude each other");
    camera.lens = choice.lens.read(shared);
  }
  camera.pinhole = choice.pinhole;
  if (!choice.sensor.empty()) camera.sensor = read_sensor(choice.sensor);
  if (!choice.size.empty()) parse_size(choice.size, camera);
  camera.film_diagonal_mm = choice.film_diagonal_mm;
  camera.aperture_diameter_mm = choice.aperture_diameter_mm;
  camera.f_number = choice.f_number;
  camera.film_distance_mm = choice.film_distance_mm;
  camera.focus_distance_m = choice.focus_distance_m;
  if (!(choice.scene_unit_mm > 0))
    throw InputError(
        fmt::format("--scene-unit {}: the length of a scene's unit in mm is above 0", choice.scene_unit_mm));
  camera.options.scene_units_per_mm = 1 / choice.scene_unit_mm;
  camera.options.diffraction = choice.diffraction;
  camera.options.origin_at_front = choice.camera_origin == "front";
  if (choice.sampling == "rear-disk")
    camera.options.sampling = render::LensCameraOptions::Sampling::rear_disk;
  return camera;
}

render::PathOptions path_options(const RenderChoice& choice, const render::SceneDescription& scene,
                                 render::Unsupported& unsupported) {
  render::PathOptions path;
  const render::Entity& integrator = scene.integrator;
  if (!integrator.type.empty() && integrator.type != "path" && integrator.type != "volpath")
    unsupported.report(integrator.location(), fmt::format("Integrator \"{}\"", integrator.type));
  path.max_depth = integrator.parameters.integer("maxdepth", path.max_depth);
  if (choice.max_depth > 0) path.max_depth = choice.max_depth;
  for (const char* ignored : {"lightsampler", "regularize"}) integrator.parameters.find(ignored);
  unsupported.report_unused(integrator.parameters, fmt::format("Integrator \"{}\"", integrator.type));
  return path;
}

/// White light of this luminance from all around.
render::LightDescription white_sky(double cd_m2) {
  render::EntityMaker light("infinite", {std::make_shared<const std::string>("--sky"), 0, 0});
  return {light.rgb("L", {1, 1, 1}).number("scale", cd_m2 / lumens_per_watt).made(), {}};
}

render::SceneDescription read_description(const std::string& name, render::Unsupported& unsupported) {
  const std::string path = find_data_file("scenes", ".pbrt", name, "three-dimensional scene");
  return render::has_gltf_name(path) ? render::read_gltf_scene(path, unsupported)
                                     : render::read_scene_description(path, unsupported);
}

PreparedScene prepare(const RenderChoice& choice, const std::vector<double>& wavelengths_nm,
                      const Shared& shared, render::Unsupported& unsupported) {
  PreparedScene prepared;
  prepared.description = read_description(choice.scene, unsupported);
  if (choice.sky_cd_m2) prepared.description.lights.push_back(white_sky(*choice.sky_cd_m2));
  prepared.camera = render::set_up_camera(prepared.description, camera_choice(choice, shared), unsupported);
  if (prepared.camera.lens) {
    Lens& lens = *prepared.camera.lens;
    lens.surfaces[lens.stop_index()].blades = choice.blades.blades(lens);
  } else if (choice.blades.count || choice.blades.rotation_deg) {
    throw InputError("blades belong to a lens; --lens names one");
  }
  if (choice.losses.any()) {
    if (!prepared.camera.lens)
      throw InputError("reflection and absorption belong to a lens; --lens names one");
    prepared.camera.options.losses = choice.losses.losses(*prepared.camera.lens, shared);
  }
  if (choice.near_distance) prepared.camera.clipping.near = *choice.near_distance;
  if (choice.far_distance) prepared.camera.clipping.far = *choice.far_distance;
  if (!(prepared.camera.clipping.near < prepared.camera.clipping.far))
    throw InputError(fmt::format("nothing lies between the clipping planes at {:g} and {:g}",
                                 prepared.camera.clipping.near, prepared.camera.clipping.far));
  prepared.path = path_options(choice, prepared.description, unsupported);
  const render::WavelengthGroups groups(
      choice.wavelengths.empty() ? wavelengths_nm : parse_wavelengths_nm(choice.wavelengths));
  prepared.world = render::build_world(prepared.description, groups, {choice.absolute_spectra}, unsupported);
  return prepared;
}

}  // namespace

void RenderChoice::add_to(CLI::App& command) {
  command
      .add_option(
          "scene", scene,
          "Scene in the text format of pbrt-v4 or in glTF 2.0 (.gltf, .glb), or the name of a bundled one")
      ->required();
  lens.add_to(command, false, false);
  losses.add_to(command);
  command.add_option("--film-diagonal", film_diagonal_mm, "Of the film, corner to corner [mm]");
  command.add_option("--aperture-diameter", aperture_diameter_mm, "Of the stop [mm]");
  command.add_option("--f-number", f_number, "Stop down to this paraxial f-number at infinity");
  blades.add_to(command);
  command.add_flag("--diffraction", diffraction,
                   "Bend rays at the stop at random as its edge does: spread without rings, more noise");
  command.add_option("--film-distance", film_distance_mm, "From the last surface to the film [mm]");
  command.add_option("--focus-distance", focus_distance_m, "From the film to what is to be sharp [m]");
  command.add_flag("--pinhole", pinhole, "The scene's perspective through a pinhole, for comparison");
  command.add_option(
      "--sensor", sensor,
      "Sensor, by name or file, or 768x576@6.25 (pixels @ pitch in um): its size, pitch, photosite "
      "and optical low-pass filter in place of the scene's film");
  command.add_option("--size", size, "Of the picture in pixels, as 400x300; of the middle of a --sensor");
  command.add_option("--wavelengths", wavelengths, "FROM:STEP:TO or a list [nm]");
  command
      .add_option(
          "--sampling", sampling,
          "Directions from a film point: inside of the pupil, or over the disk of the last surface (2006)")
      ->check(CLI::IsMember({"exit-pupil", "rear-disk"}))
      ->capture_default_str();
  command.add_option("--camera-origin", camera_origin, "What stands where the scene puts its camera")
      ->check(CLI::IsMember({"film", "front"}))
      ->capture_default_str();
  command.add_option("--scene-unit", scene_unit_mm, "Length of the scene's unit [mm]")->capture_default_str();
  command
      .add_option("--max-depth", max_depth,
                  "Times that light is scattered at most; default: the scene's, or 5")
      ->check(CLI::Range(1, 10000));
  command
      .add_option(
          "--near", near_distance,
          "Surfaces nearer than this to the camera's place, along its axis, are not seen [scene units]")
      ->check(positive_number());
  command.add_option("--far", far_distance, "Nor surfaces beyond this")->check(positive_number());
  command
      .add_option("--sky", sky_cd_m2,
                  "White light from all around of this luminance, added to that of the scene [cd/m2]")
      ->check(positive_number());
  command.add_flag("--skip-unsupported", skip_unsupported,
                   "Leave out what the scene has and Petzval has not, instead of refusing the scene");
  command.add_flag(
      "--absolute-spectra", absolute_spectra,
      "Spectra of lights are radiances [W/(m2 sr nm)] as they stand, not scaled as pbrt-v4 scales them");
}

PreparedScene prepare_scene(const RenderChoice& choice, const std::vector<double>& wavelengths_nm,
                            const Shared& shared) {
  render::Unsupported unsupported(choice.skip_unsupported);
  PreparedScene prepared = prepare(choice, wavelengths_nm, shared, unsupported);
  for (const auto* notes : {&prepared.description.notes, &prepared.camera.notes})
    for (const std::string& line : *notes) note(shared, line);
  if (const std::size_t count = unsupported.list().size(); count > 0)
    note(shared,
         fmt::format("{} of the scene's features are left out; --list-unsupported shows them", count));
  return prepared;
}

std::vector<render::Complaint> unsupported_in(const RenderChoice& choice, const Shared& shared) {
  render::Unsupported unsupported(true);
  prepare(choice, {550}, shared, unsupported);
  return unsupported.list();
}

}  // namespace petzval::app
