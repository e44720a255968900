// SPDX-License-Identifier: BSD-3-Clause
// petzval render: a three-dimensional scene through a lens.
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/stop.h>
#include <petzval/simulate/render_estimate.h>

#include <chrono>
#include <utility>

#include "field_option.h"
#include "focus_output.h"
#include "interrupted.h"
#include "output_option.h"
#include "plot_output.h"
#include "render_option.h"
#include "render_output.h"
#include "scene_list.h"
#include "sweep_frames.h"

namespace petzval::app {

namespace {

struct RenderCommand {
  RenderChoice choice;
  RenderOutputs outputs;
  std::string focus_plot, preview;
  bool autofocus = false, list_unsupported = false, list = false, dry_run = false, show_zones = false;

  bool focuses_itself() const {
    return autofocus || !choice.autofocus.zones_file.empty() || !choice.autofocus.zones.empty();
  }
};

/// With line and column of a text file, or the path of an entry of a JSON file.
nlohmann::ordered_json to_json(const UnsupportedFeature& feature) {
  nlohmann::ordered_json row{{"file", feature.file}};
  if (feature.path) {
    row["path"] = *feature.path;
  } else {
    row["line"] = feature.line;
    row["column"] = feature.column;
  }
  row["unsupported"] = feature.what;
  return row;
}

void list_unsupported(const RenderRequest& request, const Shared& shared) {
  const std::vector<UnsupportedFeature> list = unsupported_features(request, context_of(shared));
  if (shared.json) {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const UnsupportedFeature& each : list) rows.push_back(to_json(each));
    return print_json({{"scene", request.scene}, {"rows", rows}});
  }
  for (const UnsupportedFeature& each : list) fmt::print("{}: {}\n", each.place, each.what);
  if (list.empty()) fmt::print("{}: everything is supported\n", request.scene);
}

RenderRequest read_request(const RenderCommand& command, const Shared& shared) {
  const RenderChoice& choice = command.choice;
  RenderRequest request = choice.read(shared);
  request.focus_as_in_scene = choice.camera.focus.empty() && !command.focuses_itself();
  if (command.focuses_itself() && choice.camera.image_distance_mm)
    throw InputError("--film-distance and autofocus both place the film; one of them would be right");
  if (command.focuses_itself() && request.camera.focus.kind != Focus::Kind::automatic)
    throw InputError(fmt::format("--focus {} and autofocus both place the film; one of them would be right",
                                 choice.camera.focus));
  request.first_surfaces = command.outputs.first_surfaces();
  request.light_groups = !command.outputs.light_groups.empty();
  return request;
}

/// Moves the film to where the zones are sharpest, and tells how it was found.
void focus(const RenderCommand& command, const Context& context, const Shared& shared, PreparedScene& scene) {
  const FocusRun& run = autofocus(scene, context);
  if (!command.focus_plot.empty()) draw_focus(run, command.focus_plot);
  if (!shared.quiet && !shared.json) fmt::print("{}", focus_text(run, command.choice.autofocus.measure));
}

/// The picture of the light as far as it has come, instead of the one before.
void write_preview(const Rendering& picture, const RenderCommand& command, const Context& context) {
  Context silent = context;
  silent.note = {};
  OutputOptions shown = command.outputs.shot.options();
  shown.picture = OutputOptions::Shows::irradiance;
  write_outputs(picture.irradiance, {command.preview}, {}, shown, silent);
}

std::string how_to_go_on(const RenderRequest& request, int samples) {
  const std::string saved = fmt::format("the same command goes on from {}", request.checkpoint);
  if (request.checkpoint.empty()) return "with --checkpoint FILE the same command would go on from there";
  return samples > 0 ? saved : "it begins anew, for no pass over the picture was complete";
}

/// The light; when the user stops it, what there is of it is written.
Rendering render_or_save(const RenderCommand& command, const PreparedScene& scene,
                         const OutputOptions& outputs, const Context& context) {
  std::optional<Rendering> stopped_at;
  PictureWatch watch;
  watch.show = [&](const Rendering& so_far, bool stopped) {
    if (stopped)
      stopped_at = so_far;
    else
      write_preview(so_far, command, context);
  };
  constexpr double preview_s = 5;
  if (!command.preview.empty()) watch.every_s = preview_s;
  try {
    return render_scene(scene, context, watch);
  } catch (const Cancelled&) {
    if (!stopped_at) throw;
    const ListenerScope unhurried(nullptr);
    command.outputs.write(*stopped_at, scene, scene.request.camera.sensor, outputs, context);
    const bool whole = stopped_at->complete;
    throw Interrupted(fmt::format("stopped {} {} samples a pixel; the picture so far is written, and {}",
                                  whole ? "after" : "within the first", stopped_at->samples_per_pixel,
                                  how_to_go_on(scene.request, whole ? stopped_at->samples_per_pixel : 0)));
  }
}

/// What the command would take, from a small picture of the scene.
void estimate(const RenderCommand& command, const PreparedScene& scene, const Context& context,
              const Shared& shared) {
  const RenderEstimate cost = estimate_render(scene, context);
  if (shared.json)
    return print_json({{"scene", command.choice.request.scene},
                       {"samples_per_pixel", cost.samples_per_pixel},
                       {"seconds", cost.seconds},
                       {"memory_bytes", cost.memory_bytes},
                       {"probe_seconds", cost.probe_seconds}});
  fmt::print("{} x {} pixels, {} samples each: about {}, and {:.3g} MB for the light\n", scene.film.columns,
             scene.film.rows, cost.samples_per_pixel, duration_text(cost.seconds), cost.memory_bytes / 1e6);
}

PreparedScene prepared(const RenderRequest& request, const Context& context, const Shared& shared) {
  return shared.renders ? shared.renders->prepare(request, context) : prepare_scene(request, context);
}

/// One piece of the picture, into its checkpoint: what the command would write waits for all pieces.
void render_piece(const PreparedScene& scene, const Context& context, const Shared& shared) {
  const Rendering piece = render_scene(scene, context);
  if (shared.json)
    return print_json({{"scene", scene.request.scene},
                       {"columns", piece.irradiance.columns()},
                       {"rows", piece.irradiance.rows()},
                       {"samples_per_pixel", piece.samples_per_pixel},
                       {"camera_rays", piece.rays},
                       {"checkpoint", scene.request.checkpoint}});
  if (!shared.quiet)
    fmt::print("{}: the sums of {} x {} pixels, {} samples each\n", scene.request.checkpoint,
               piece.irradiance.columns(), piece.irradiance.rows(), piece.samples_per_pixel);
}

void run_render(const RenderCommand& command, const CLI::App& app, const Shared& shared) {
  if (command.list) return print_scenes(rows_of_worlds(), shared.json);
  if (command.choice.request.scene.empty())
    throw InputError(
        "a scene would be right: a .pbrt, .gltf or .glb file or a name of petzval render --list");
  const RenderRequest request = read_request(command, shared);
  if (command.list_unsupported) return list_unsupported(request, shared);
  if (command.dry_run) {
    const Context context = context_of(shared);
    return estimate(command, prepare_scene(request, context), context, shared);
  }
  const std::optional<Sensor>& sensor = request.camera.sensor;
  OutputOptions outputs = command.outputs.checked(sensor, app);
  const FlareOptions flare = command.outputs.flare.options();
  if (!command.focus_plot.empty()) require_drawing(command.focus_plot, "a plot");
  if (!command.preview.empty()) require_extension(command.preview, {".png"}, "a preview");

  const auto start = std::chrono::steady_clock::now();
  const auto seconds_since = [](std::chrono::steady_clock::time_point from) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
  };
  const Context context = context_of(shared);
  PreparedScene scene = prepared(request, context, shared);
  command.outputs.keep_off(scene.files, {{"--focus-plot", command.focus_plot},
                                         {"--preview", command.preview},
                                         {"--checkpoint", request.checkpoint}});
  // Also without a lens, which is then said.
  if (!request.focus_as_in_scene && !request.focus_pixel && !request.camera.image_distance_mm &&
      request.camera.focus.kind == Focus::Kind::automatic)
    focus(command, context, shared, scene);
  if (command.show_zones) outputs.shown.frames = frames_of_zones(scene);
  if (shared.frames && !request.is_piece() && shared.frames->takes(scene)) return;
  RenderSeconds seconds{seconds_since(start), 0};
  const auto begin = std::chrono::steady_clock::now();
  std::optional<FlareLayers> layers;
  if (flare.any() && !request.is_piece()) layers = scene_flare(scene, flare, context);
  if (request.is_piece()) return render_piece(scene, context, shared);
  Rendering picture =
      shared.frames ? shared.frames->picture() : render_or_save(command, scene, outputs, context);
  if (layers) add_scene_flare(scene, flare, *layers, picture.irradiance, context);
  seconds.light = seconds_since(begin);
  const Outputs made =
      command.outputs.write(picture, scene, sensor, outputs, context, layers ? &*layers : nullptr);
  if (shared.json) {
    nlohmann::ordered_json json = summary_json(scene, picture, made, seconds, command.outputs.pictures);
    if (layers) json["flare"] = flare_json(*layers);
    return print_json(json);
  }
  if (shared.quiet) return;
  print_summary(scene, picture, made, seconds);
  if (layers) print_flare(*layers);
}

void add_focus_options(RenderCommand& options, CLI::App& command) {
  command.add_option(
      "--focus", options.choice.camera.focus,
      "Where the film stands: auto (sharp on the zones, by autofocus), design (as in the prescription), "
      "infinity, the distance from the film of what is to be sharp (1.2m, 250mm), pixel@COLUMN,ROW (what is "
      "seen there), paraxial, best-spot, "
      "best-mtf@CYCLES_PER_MM, or these of an object there (250mm+best-spot); default: as the scene's file "
      "says");
  options.choice.camera.add_focus_corrections(command);
  command
      .add_option("--film-distance,--image-distance", options.choice.camera.image_distance_mm,
                  "From the last surface to the film [mm]")
      ->check(positive_number());
  command
      .add_option_function<std::string>(
          "--autofocus",
          [&options](const std::string& zones_file) {
            options.autofocus = true;
            options.choice.autofocus.zones_file = zones_file;
          },
          "Focus by itself on the zones of this file (see petzval focus), or on the middle of the picture")
      ->expected(0, 1)
      ->type_name("[FILE]");
  command.add_flag("--show-zones", options.show_zones, "Draw the zones of autofocus into the pictures");
  command.add_option("--focus-plot", options.focus_plot, "Draw the evaluations of that: .svg, .png or .pdf")
      ->check(output_file());
}

/// What one of several processes renders.
void add_piece_options(RenderRequest& request, CLI::App& command) {
  command
      .add_option_function<std::vector<int>>(
          "--region",
          [&request](const std::vector<int>& at) {
            request.region = {at[0], at[1], at[2], at[3]};
          },
          "Only pixels from column X and row Y on, W x H of them: a piece, which goes into --checkpoint "
          "alone; "
          "petzval merge puts pieces together")
      ->delimiter(',')
      ->expected(4)
      ->check(CLI::Range(0, 1 << 24))
      ->type_name("X,Y,W,H");
  command
      .add_option_function<std::vector<int>>(
          "--sample-range",
          [&request](const std::vector<int>& at) {
            request.sample_range = {at[0], at[1]};
          },
          "Only samples from FIRST up to LAST of those of --spp, likewise")
      ->delimiter(':')
      ->expected(2)
      ->check(CLI::Range(0, 1 << 24))
      ->type_name("FIRST:LAST");
}

void add_sampling_options(RenderRequest& request, CLI::App& command) {
  command
      .add_option("--spp", request.samples_per_pixel,
                  "Camera paths a pixel; each serves up to eight wavelengths; default: 64, with --noise "
                  "at most 4096")
      ->check(CLI::Range(1, 1 << 24));
  command
      .add_option("--noise", request.noise,
                  "End as soon as nine of ten tiles are estimated to be this close to the picture without "
                  "noise: RMS error over mean light, 0.02 for instance")
      ->check(positive_number());
  command.add_flag("--denoise-light", request.denoise_light,
                   "Take most of the noise out of the light: surfaces that are alike share theirs. The files "
                   "say so, and the checkpoint keeps the light as it was");
  command
      .add_option(
          "--checkpoint", request.checkpoint,
          "A file to save to, on the way, at the end and on Ctrl-C, and to go on from: a larger --spp "
          "then adds samples")
      ->check(output_file());
  command.add_option("--checkpoint-seconds", request.checkpoint_seconds, "How often")
      ->check(number_not_negative())
      ->capture_default_str();
  add_piece_options(request, command);
}

}  // namespace

void add_render_command(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<RenderCommand>();
  CLI::App* command = add_command(
      app, shared, "render", "Render a three-dimensional scene through a lens",
      "petzval render spheres --lens dgauss-50mm --focus 1.2m --size 120x90 --spp 16 "
      "-o spheres.png",
      true, [options, &shared, &app] { run_render(*options, *app.get_subcommand("render"), shared); });
  options->choice.add_to(*command);
  add_focus_options(*options, *command);
  add_sampling_options(options->choice.request, *command);
  command->add_flag("--list", options->list, "Only list the bundled three-dimensional scenes");
  command->add_flag("--dry-run", options->dry_run,
                    "Only estimate time and memory, from a small picture of the scene");
  command
      ->add_option("--preview", options->preview,
                   "A .png of the light so far, written anew every few seconds while it renders")
      ->check(output_file());
  command->add_flag("--list-unsupported", options->list_unsupported,
                    "Only list what the scene has and Petzval has not, each with its place");
  options->outputs.add_to(*command);
}

}  // namespace petzval::app
