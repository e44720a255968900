// SPDX-License-Identifier: BSD-3-Clause
// petzval image: a planar scene through a lens, onto a sensor.
#include <fmt/format.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/progress.h>

#include <memory>
#include <span>
#include <utility>

#include "image_depth.h"
#include "image_option.h"
#include "image_output.h"
#include "image_source.h"
#include "sensor_option.h"

namespace petzval::app {

namespace {

void image(const ImageChoice& choice, const CLI::App& app, const Shared& shared) {
  choice.check();
  if (choice.scene_angle_least && !fills_frame(choice))
    throw InputError(
        "--scene-angle-least is for a chart or a photograph that fills the frame of a --sensor; "
        "--scene-angle "
        "would be right");
  ImagingOptions options = choice.imaging_options();
  std::optional<Sensor> sensor;
  std::optional<SensorGeometry> wanted;
  if (!choice.sensor.empty()) {
    sensor = read_sensor(choice.sensor, choice.sensor_settings);
    wanted = sensor->geometry;
    options.photosite = sensor->photosite;
  }
  choice.shot.check(sensor, choice.outputs, app);

  ProgressBar bar(!shared.quiet);
  auto [scene, table, depth] = read_source(choice, wanted, bar.callback(), shared);
  choice.scene.print_notes(scene, shared);
  const SensorGeometry frame = fit_to_each_other(choice, options, scene, table, depth, wanted, shared);
  check_depth(scene, depth.has_value(), choice.depth, shared);

  DepthReport deep;
  ImagingReport& report = deep.image;
  FormedImage formed = {.frame = frame,
                        .light = {},
                        .file = {},
                        .scene = std::move(scene),
                        .table = std::move(table),
                        .report = {},
                        .method = {}};
  if (!depth) formed.file = large_file(choice.outputs, frame, formed.scene);
  if (depth)
    formed.light =
        form_depth_image(formed.scene, *depth, frame, options, choice.depth, bar.callback(), &deep);
  else if (formed.file)
    form_bands(
        formed.scene, formed.table, frame, options,
        [&](std::span<const float> pixels) { formed.file->bands().add(pixels); }, bar.callback(), &report);
  else
    formed.light = form_image(formed.scene, formed.table, frame, options, bar.callback(), &report);
  formed.method = method_text(options, report);
  if (formed.light)
    formed.light->provenance =
        fmt::format("petzval {} image: {} {} through {}, working f-number {:.4g}; {}", version(),
                    formed.scene.name, distance_text(formed.scene), formed.table.lens_name,
                    formed.table.first_order.working_f_number, formed.method);
  for (const std::string& line : report.notes) note(shared, line);
  formed.report = std::move(report);
  const std::optional<Shot> shot = write_outputs(choice, formed, sensor, shared);
  if (shared.json) return print_json(with_layers(summary_json(formed, shot, choice.outputs), deep));
  if (shared.quiet) return;
  print_summary(formed, shot);
  print_layers(deep, frame.pitch_um);
}

}  // namespace

void add_image_command(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<ImageChoice>();
  CLI::App* command =
      add_command(app, shared, "image", "Image a scene through a lens onto a sensor",
                  "petzval image studio --lens edmund-54852 --sensor 320x240@15 -o studio.png "
                  "-o studio.exr",
                  true, [options, &shared, &app] { image(*options, *app.get_subcommand("image"), shared); });
  options->add_to(*command);
}

}  // namespace petzval::app
