// SPDX-License-Identifier: BSD-3-Clause
// petzval shoot: a clip of a scene that moves, frame by frame into a folder.
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/file_extension.h>
#include <petzval/base/staged_files.h>
#include <petzval/base/whole_file.h>
#include <petzval/isp/raw_output.h>
#include <petzval/scene/wavelength_list.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "clip_folder.h"
#include "clip_option.h"
#include "field_option.h"
#include "image_option.h"
#include "interrupted.h"
#include "output_option.h"

namespace petzval::app {

namespace {

constexpr const char* frame_exposing = "Exposing the sensor";
constexpr const char* frame_developing = "Developing the frames";

struct ShootCommand {
  ImageChoice light;
  ClipChoice clip;
  SenseChoice sense;
  DevelopChoice develop;
  std::vector<std::string> formats{"png"};
  int bits = 8;
  std::optional<int> samples;
  std::string folder;
};

const char* shutter_name(const Shutter& shutter) {
  return shutter.kind == Shutter::Kind::rolling ? "rolling" : "global";
}

nlohmann::ordered_json facts_of(const Clip& clip, const ClipOptions& options, const Sensor& sensor,
                                const CLI::App& app, const std::string& folder) {
  return {{"frames", options.frames},
          {"fps", options.fps},
          {"columns", sensor.geometry.columns},
          {"rows", sensor.geometry.rows},
          {"exposure_s", clip.exposure_s()},
          {"shutter", shutter_name(clip.shutter())},
          {"row_time_s", clip.shutter().row_time_s},
          {"asked_for", asked_for(app, folder)}};
}

void write_frame(const ClipFolder& folder, int frame, const RawImage& raw, const ShootCommand& command,
                 const Development& development, const Context& context) {
  StagedFiles files;
  for (const std::string& format : command.formats) {
    const std::string path = files.stage(folder.path(frame, format));
    if (format != "dng")
      write_picture(path, petzval::develop(raw, development, context), command.bits);
    else
      write_raw_output(path, raw);
  }
  files.commit();
}

/// Lines of "t column row polarity", as data sets of event cameras have them.
/// Whether the scene is one in three dimensions.
bool has_depth_of_space(const std::string& scene) {
  const std::string extension = extension_of(scene);
  return extension == ".pbrt" || extension == ".gltf" || extension == ".glb";
}

/// Whether an option is one for scenes in three dimensions alone, or for others alone; absent: for both.
std::optional<bool> effect_in_space(const std::string& option) {
  if (option == "--instants" || option == "--spp") return true;
  constexpr const char* of_planes[] = {"--method",   "--tolerance",   "--nodes",       "--tile",
                                       "--section",  "--transform",   "--supersample", "--fit",
                                       "--surround", "--interpolate", "--layers",      "--motion-step"};
  if (option.starts_with("--scene-") || std::ranges::count(of_planes, option) > 0) return false;
  return {};
}

std::unique_ptr<Clip> clip_of(const ShootCommand& command, Optics optics, const Sensor& sensor,
                              const ClipOptions& options, const CLI::App& app, const Context& context) {
  const bool in_space = has_depth_of_space(command.light.scene.path_or_name);
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = option->get_name();
    if (option->count() == 0 || effect_in_space(name).value_or(in_space) == in_space) continue;
    throw InputError(in_space ? fmt::format("{} has no effect on a scene in three dimensions", name)
                              : fmt::format("{} is for a scene in three dimensions, a .pbrt file", name));
  }
  if (!in_space)
    return std::make_unique<Clip>(plan_clip(command.light.scene.request(), std::move(optics),
                                            command.light.image_options(), options.motion, context),
                                  sensor, options, context);
  RenderRequest request;
  request.scene = command.light.scene.path_or_name;
  if (Camera* camera = std::get_if<Camera>(&optics))
    request.camera = std::move(*camera);
  else
    throw InputError("a scene in three dimensions is seen through a lens; --lens would be right");
  if (!command.light.scene.wavelengths.empty())
    request.wavelengths_nm = parse_wavelengths_nm(command.light.scene.wavelengths);
  request.samples_per_pixel = command.samples;
  return std::make_unique<Clip>(request, sensor, options, context);
}

std::size_t write_events(const std::string& path, const Clip& clip, const EventCameraOptions& camera,
                         const Context& context) {
  WholeFile file(path);
  std::ofstream out(file.temporary_path());
  std::size_t count = 0;
  clip.events(
      camera,
      [&](const std::vector<Event>& events) {
        for (const Event& event : events)
          out << fmt::format("{:.9f} {} {} {}\n", event.t_s, event.column, event.row, event.brighter ? 1 : 0);
        count += events.size();
      },
      context);
  out.close();
  if (!out) throw Failure(fmt::format("{}: cannot be written", path));
  file.commit();
  return count;
}

/// Part of the work of a command, for its progress.
Context part_of(const Context& context, double from, double share) {
  Context part = context;
  if (context.progress)
    part.progress = [&context, from, share](double fraction, const std::string& what) {
      return context.progress(from + share * fraction, what);
    };
  return part;
}

void run_shoot(const ShootCommand& command, const CLI::App& app, const Shared& shared) {
  const Context context = context_of(shared);
  if (!command.develop.steps.empty())
    throw InputError(
        "--step writes steps of one picture; petzval develop of a frame (--format dng) would be right");
  Optics optics = command.light.read_optics(shared);
  const std::optional<Sensor> chosen = std::visit([](const auto& camera) { return camera.sensor; }, optics);
  if (!chosen || !chosen->electronics)
    throw InputError("a clip needs a sensor that counts photons; --sensor third-inch-1280x960 would be one");
  const Sensor& sensor = *chosen;
  ClipOptions options = command.clip.options(sensor, shared.seed);
  options.expose = command.sense.options();
  const EventCameraOptions event_camera = command.clip.event_options(app, sensor, shared.seed);
  const Development development = command.develop.development();

  const std::unique_ptr<const Clip> shot = clip_of(command, std::move(optics), sensor, options, app, context);
  const Clip& clip = *shot;
  const ClipFolder folder(command.folder, command.formats,
                          facts_of(clip, options, sensor, app, command.folder));

  int kept = 0, made = 0;
  const double parts = options.frames + (command.clip.events ? 1 : 0);
  std::optional<std::size_t> events;
  try {
    for (int frame = 0; frame < options.frames; ++frame) {
      if (folder.has(frame)) {
        ++kept;
        continue;
      }
      const Context here = part_of(context, frame / parts, 1 / parts);
      write_frame(folder, frame, clip.frame(frame, here), command, development, here);
      ++made;
    }
    if (command.clip.events)
      events = write_events(folder.path("events.txt"), clip, event_camera,
                            part_of(context, options.frames / parts, 1 / parts));
  } catch (const Cancelled&) {
    throw Interrupted(fmt::format("stopped after {} of {} frames; the same command goes on from there",
                                  kept + made, options.frames));
  }

  if (shared.json) {
    nlohmann::ordered_json json = facts_of(clip, options, sensor, app, command.folder);
    json.erase("asked_for");
    json["instants_per_frame"] = clip.instants(0);
    json["frames_kept"] = kept;
    if (events) json["events"] = *events;
    json["output"] = command.folder;
    return print_json(json);
  }
  if (shared.quiet) return;
  fmt::print("{} frames of {} x {} pixels, {:g} a second\n", options.frames, sensor.geometry.columns,
             sensor.geometry.rows, options.fps);
  fmt::print("  exposure    {:.4g} s, {} instants of light a frame\n", clip.exposure_s(), clip.instants(0));
  fmt::print("  shutter     {}\n", clip.shutter().kind == Shutter::Kind::rolling
                                       ? fmt::format("rolling, {:.4g} us a row, {:.4g} ms from top to bottom",
                                                     clip.shutter().row_time_s * 1e6,
                                                     clip.shutter().row_delay_s(sensor.geometry.rows) * 1e3)
                                       : std::string("global"));
  if (events) fmt::print("  events      {}\n", *events);
  if (kept > 0) fmt::print("  {} frames were there already\n", kept);
}

}  // namespace

void add_shoot_command(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<ShootCommand>();
  CLI::App* command = add_command(
      app, shared, "shoot", "Shoot a clip: motion, rolling shutter, flicker, frame by frame",
      "petzval shoot studio --lens edmund-54852 --sensor third-inch-1280x960 --sensor-set columns=320 "
      "--sensor-set rows=240 --wavelengths 450:100:650 --pan 20 --frames 4 -o clip",
      true, [options, &shared, &app] { run_shoot(*options, *app.get_subcommand("shoot"), shared); });
  options->light.add_light_to(*command);
  options->clip.add_to(*command);
  command
      ->add_option("--spp", options->samples,
                   "Paths a pixel at each instant of a scene in three dimensions; default: 64")
      ->check(whole_number());
  command
      ->add_option("-o,--output", options->folder,
                   "Folder of the frames; those that are there already, of the same clip, are kept")
      ->check(output_folder())
      ->required();
  command
      ->add_option("--format", options->formats,
                   "Of the frames: png, jpg, tif, dng; several with commas between")
      ->delimiter(',')
      ->check(CLI::IsMember({"png", "jpg", "tif", "dng"}))
      ->capture_default_str();
  command->add_option("--bits", options->bits, "Of pictures: 8 or 16")
      ->check(CLI::IsMember({8, 16}))
      ->capture_default_str();
  const std::string before = command->option_defaults()->get_group();
  command->option_defaults()->group(frame_exposing);
  options->sense.add_to(*command, true, true);
  command->option_defaults()->group(frame_developing);
  options->develop.add_to(*command, true);
  command->option_defaults()->group(before);
}

}  // namespace petzval::app
