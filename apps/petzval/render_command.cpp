// SPDX-License-Identifier: BSD-3-Clause
// petzval render: a three-dimensional scene through a lens.
#include <fmt/format.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/file_extension.h>
#include <petzval/base/progress.h>
#include <petzval/base/staged_files.h>
#include <petzval/image/formats/irradiance.h>
#include <petzval/image/formats/npy.h>
#include <petzval/image/picture.h>
#include <petzval/render/pbrt/scene_files.h>
#include <petzval/render/renderer.h>
#include <petzval/sensor/lens_facts.h>

#include <chrono>
#include <filesystem>

#include "field_option.h"
#include "focus_output.h"
#include "output_option.h"
#include "render_fingerprint.h"
#include "render_option.h"
#include "scene_focus.h"

namespace petzval::app {

namespace {

struct RenderCommand {
  RenderChoice choice;
  FocusChoice focus;
  std::optional<int> samples;
  int bits = 8;
  double noise = 0;
  double checkpoint_seconds = 60;
  std::string checkpoint, depth, normals, albedo, focus_plot;
  std::optional<double> white;
  bool list_unsupported = false;
  std::vector<std::string> outputs;
};

/// 31 bands over the visible, as scenes have them.
std::vector<double> default_wavelengths_nm() {
  std::vector<double> result;
  for (int nm = 400; nm <= 700; nm += 10) result.push_back(nm);
  return result;
}

/// With line and column of a text file, or the path of an entry of a JSON file.
nlohmann::ordered_json complaint_json(const render::Complaint& complaint) {
  const render::Location& at = complaint.at;
  nlohmann::ordered_json row{{"file", at.file ? *at.file : ""}};
  if (at.path) {
    row["path"] = *at.path;
  } else {
    row["line"] = at.line;
    row["column"] = at.column;
  }
  row["unsupported"] = complaint.what;
  return row;
}

void list_unsupported(const RenderCommand& command, const Shared& shared) {
  const std::vector<render::Complaint> list = unsupported_in(command.choice, shared);
  if (shared.json) {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const render::Complaint& each : list) rows.push_back(complaint_json(each));
    return print_json({{"scene", command.choice.scene}, {"rows", rows}});
  }
  for (const render::Complaint& each : list) fmt::print("{}: {}\n", each.at.text(), each.what);
  if (list.empty()) fmt::print("{}: everything is supported\n", command.choice.scene);
}

std::string camera_text(const render::SceneCamera& camera) {
  if (!camera.lens)
    return camera.perspective.lens_radius > 0 ? "thin lens (irradiance as radiance times 1 sr)"
                                              : "pinhole (irradiance as radiance times 1 sr)";
  return fmt::format("{}, film {:.6g} mm behind the last surface, stop {:.4g} mm wide", camera.lens->name,
                     camera.film_distance_mm(), 2 * stop_radius_mm(*camera.lens));
}

nlohmann::ordered_json summary_json(const RenderCommand& command, const PreparedScene& scene,
                                    const render::Rendering& picture, double prepare_seconds,
                                    double render_seconds) {
  const SpectralImage& image = picture.irradiance;
  const render::SceneCamera& camera = scene.camera;
  const std::span<const float> values = image.values();
  double sum = 0;
  for (const float value : values) sum += static_cast<double>(value);
  return {{"scene", command.choice.scene},
          {"lens", camera.lens ? nlohmann::ordered_json(camera.lens->name) : nlohmann::ordered_json()},
          {"film_distance_mm",
           camera.lens ? nlohmann::ordered_json(camera.film_distance_mm()) : nlohmann::ordered_json()},
          {"columns", image.columns()},
          {"rows", image.rows()},
          {"pitch_um", image.pitch_um()},
          {"pixel_aperture", scene.camera.photosite.text()},
          {"wavelengths_nm", image.wavelengths_nm()},
          {"samples_per_pixel", picture.samples_per_pixel},
          {"noise", picture.noise ? nlohmann::ordered_json(*picture.noise) : nlohmann::ordered_json()},
          {"camera_rays", picture.rays},
          {"camera_rays_passed", picture.passed},
          {"mean_irradiance", sum / static_cast<double>(values.size())},
          {"irradiance_unit", "W.m^-2.nm^-1"},
          {"prepare_seconds", prepare_seconds},
          {"render_seconds", render_seconds},
          {"outputs", command.outputs}};
}

void print_summary(const PreparedScene& scene, const render::Rendering& picture, double prepare_seconds,
                   double render_seconds) {
  const SpectralImage& image = picture.irradiance;
  const auto& bands = image.wavelengths_nm();
  fmt::print("{} x {} pixels of {:.5g} um, ", image.columns(), image.rows(), image.pitch_um());
  if (bands.size() == 1)
    fmt::print("1 band at {:g} nm\n", bands.front());
  else
    fmt::print("{} bands from {:g} to {:g} nm\n", bands.size(), bands.front(), bands.back());
  fmt::print("  camera   {}\n", camera_text(scene.camera));
  fmt::print("  samples  {} a pixel; {:.1f} % of {} camera rays pass\n", picture.samples_per_pixel,
             100.0 * static_cast<double>(picture.passed) /
                 static_cast<double>(std::max<std::uint64_t>(picture.rays, 1)),
             picture.rays);
  if (picture.noise) fmt::print("  noise    {:.3g} (RMS error over mean light)\n", *picture.noise);
  fmt::print("  time     {:.2f} s to prepare, {:.1f} s for light, {:.3g} million camera rays a second\n",
             prepare_seconds, render_seconds,
             static_cast<double>(picture.rays) * 1e-6 / std::max(render_seconds, 1e-9));
}

void write_outputs(const RenderCommand& command, render::Rendering& picture, const Shared& shared) {
  StagedFiles files;
  for (const std::string& path : command.outputs) {
    const std::string staged = files.stage(path);
    if (extension_of(path) != ".png") {
      write_irradiance(staged, picture.irradiance);
      continue;
    }
    PictureOptions options;
    if (command.white) {
      options.exposure = PictureOptions::Exposure::fixed;
      options.white_level = *command.white;
    }
    note(shared,
         fmt::format("{}: {}", path, write_picture(staged, picture.irradiance, options, command.bits)));
  }
  const auto rows = static_cast<std::size_t>(picture.irradiance.rows());
  const auto columns = static_cast<std::size_t>(picture.irradiance.columns());
  if (!command.depth.empty())
    write_npy(files.stage(command.depth), std::vector<std::size_t>{rows, columns},
              picture.first_surfaces->depth);
  if (!command.normals.empty())
    write_npy(files.stage(command.normals), std::vector<std::size_t>{rows, columns, 3},
              picture.first_surfaces->normal);
  if (!command.albedo.empty())
    write_npy(files.stage(command.albedo),
              std::vector<std::size_t>{static_cast<std::size_t>(picture.irradiance.bands()), rows, columns},
              picture.first_surfaces->albedo);
  files.commit();
}

/// Outputs over what the scene's file names: meshes, textures, included files.
void refuse_overwriting_scene(const RenderCommand& command, const PreparedScene& scene) {
  std::vector<NamedFile> outputs, inputs;
  for (const std::string& path : command.outputs) outputs.push_back({"--output", path});
  for (const auto& [option, path] :
       {NamedFile{"--depth", command.depth}, NamedFile{"--normals", command.normals},
        NamedFile{"--albedo", command.albedo}, NamedFile{"--focus-plot", command.focus_plot},
        NamedFile{"--checkpoint", command.checkpoint}})
    if (!path.empty()) outputs.push_back({option, path});
  for (const std::string& path : render::scene_files(scene.description)) inputs.push_back({"scene", path});
  refuse_same_files(outputs, inputs);
}

/// Moves the film to where the zones are sharpest, and tells how it was found.
void focus(const RenderCommand& command, const Shared& shared, PreparedScene& scene) {
  Shared silent = shared;
  silent.quiet = true;
  const FocusResult result =
      autofocus(prepare_scene(command.choice, focus_wavelengths_nm(), silent), command.focus, shared).result;
  scene.camera = scene.camera.with_film_distance_mm(result.film_distance_mm);
  note_focus_at_the_end(result, shared);
  if (!command.focus_plot.empty()) draw_focus(result, scene.camera.lens->name, command.focus_plot);
  if (!shared.quiet && !shared.json) fmt::print("{}", focus_text(result, command.focus.measure));
}

void render_scene(const RenderCommand& command, const Shared& shared) {
  if (command.list_unsupported) return list_unsupported(command, shared);
  if (command.outputs.empty()) throw InputError("-o names the picture to be written (.exr, .npy or .png)");
  for (const std::string& path : command.outputs)
    require_extension(path, {".exr", ".npy", ".png"}, "a rendering");
  for (const std::string* path : {&command.depth, &command.normals, &command.albedo})
    if (!path->empty()) require_extension(*path, {".npy"}, "a picture of first surfaces");

  const auto start = std::chrono::steady_clock::now();
  const auto seconds_since = [](std::chrono::steady_clock::time_point from) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
  };
  if (!command.focus_plot.empty()) require_extension(command.focus_plot, {".svg"}, "a plot");
  PreparedScene scene = prepare_scene(command.choice, default_wavelengths_nm(), shared);
  refuse_overwriting_scene(command, scene);
  if (!command.focus.zones_file.empty() || !command.focus.zones.empty()) focus(command, shared, scene);
  const std::unique_ptr<const render::FilmCamera> camera = scene.camera.make(scene.world->groups);
  if (scene.world->lights.empty()) note(shared, "the scene has no lights; the picture will be black");
  const double prepare_seconds = seconds_since(start);

  render::RenderOptions options;
  options.samples_per_pixel = command.samples.value_or(command.noise > 0 ? 4096 : 64);
  options.noise = command.noise;
  options.seed = shared.seed;
  options.path = scene.path;
  options.photosite = scene.camera.photosite;
  options.clipping = scene.camera.clipping;
  options.first_surfaces = !command.depth.empty() || !command.normals.empty() || !command.albedo.empty();
  options.checkpoint = command.checkpoint;
  options.checkpoint_seconds = command.checkpoint_seconds;
  if (!command.checkpoint.empty()) options.fingerprint = render_fingerprint(command.choice, scene, options);
  const int samples = render::effective_samples(scene.world->groups, options.samples_per_pixel);
  if (samples != options.samples_per_pixel)
    note(shared, fmt::format("{} bands need at least {} samples a pixel",
                             scene.world->groups.wavelengths_nm().size(), samples));
  ProgressBar bar(!shared.quiet);
  const auto begin = std::chrono::steady_clock::now();
  render::Rendering picture = render_picture(*scene.world, *camera, scene.camera.world_from_camera,
                                             scene.camera.film, options, bar.callback());
  const double render_seconds = seconds_since(begin);
  if (picture.noise && *picture.noise > command.noise)
    note(shared,
         fmt::format("the noise is {:.3g} after {} samples a pixel; a larger --spp would let it fall to {:g}",
                     *picture.noise, picture.samples_per_pixel, command.noise));
  picture.irradiance.provenance =
      fmt::format("petzval {} render: {} through {}; {} samples a pixel, seed {}", version(),
                  command.choice.scene, camera_text(scene.camera), picture.samples_per_pixel, shared.seed);
  if (scene.camera.lens)
    picture.irradiance.lens = lens_facts(scene.camera.lens->name, first_order(*scene.camera.lens));
  write_outputs(command, picture, shared);
  if (!command.checkpoint.empty()) std::filesystem::remove(command.checkpoint);
  if (shared.json) return print_json(summary_json(command, scene, picture, prepare_seconds, render_seconds));
  if (!shared.quiet) print_summary(scene, picture, prepare_seconds, render_seconds);
}

}  // namespace

void add_render_command(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<RenderCommand>();
  CLI::App* command =
      add_command(app, shared, "render", "Render a three-dimensional scene through a lens",
                  "petzval render spheres --lens dgauss-50mm --focus-distance 1.2 --size 120x90 --spp 16 "
                  "-o spheres.png",
                  true, [options, &shared] { render_scene(*options, shared); });
  options->choice.add_to(*command);
  command->add_option("--autofocus", options->focus.zones_file,
                      "Focus by itself on the zones of this file (see petzval focus)");
  command
      ->add_option("--zone", options->focus.zones,
                   "Focus by itself on a zone: left,right,top,bottom (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
  command->add_option("--focus-plot", options->focus_plot, "Draw the evaluations of that into this SVG file")
      ->check(output_file());
  options->focus.add_to(*command);
  command
      ->add_option("--spp", options->samples,
                   "Camera paths a pixel; each serves up to eight wavelengths; default: 64, with --noise "
                   "at most 4096")
      ->check(CLI::Range(1, 1 << 24));
  command
      ->add_option("--noise", options->noise,
                   "End as soon as nine of ten tiles are estimated to be this close to the picture without "
                   "noise: RMS error over mean light, 0.02 for instance")
      ->check(positive_number());
  command
      ->add_option("--checkpoint", options->checkpoint,
                   "A file to save to on the way and to go on from; removed when the picture is done")
      ->check(output_file());
  command->add_option("--checkpoint-seconds", options->checkpoint_seconds, "How often")
      ->capture_default_str();
  command
      ->add_option("--depth", options->depth,
                   "Also write the distance of what is seen from the film [scene units] (.npy)")
      ->check(output_file());
  command->add_option("--normals", options->normals, "Also write its normals in world space (.npy)")
      ->check(output_file());
  command->add_option("--albedo", options->albedo, "Also write its reflectance by band (.npy)")
      ->check(output_file());
  command->add_flag("--list-unsupported", options->list_unsupported,
                    "Only list what the scene has and Petzval has not, each with its place");
  command->add_option("--white", options->white,
                      "Illuminance that a .png shows as white [lx]; default: the brightest");
  command->add_option("--bits", options->bits, "Of a .png: 8 or 16")
      ->check(CLI::IsMember({8, 16}))
      ->capture_default_str();
  command
      ->add_option("-o,--output", options->outputs,
                   "Irradiance as .exr or .npy, a picture as .png; repeatable")
      ->check(output_file())
      ->allow_extra_args(false);
}

}  // namespace petzval::app
