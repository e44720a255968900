// SPDX-License-Identifier: BSD-3-Clause
// petzval image: a planar scene through a lens, onto a sensor.
#include <fmt/format.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/parallel.h>
#include <petzval/base/progress.h>

#include <memory>

#include "image_depth.h"
#include "image_option.h"
#include "image_output.h"
#include "image_source.h"
#include "sensor_option.h"

namespace petzval::app {

namespace {

void image(const ImageChoice& choice, const CLI::App& app, const Shared& shared) {
  choice.check();
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
  SpectralImage light =
      depth ? form_depth_image(scene, *depth, frame, options, choice.depth, bar.callback(), &deep)
            : form_image(scene, table, frame, options, bar.callback(), &report);
  const std::string method = method_text(options, report);
  light.provenance =
      fmt::format("petzval {} image: {} {} through {}, working f-number {:.4g}; {}", version(), scene.name,
                  distance_text(scene), table.lens_name, table.first_order.working_f_number, method);
  for (const std::string& line : report.notes) note(shared, line);
  FormedImage formed = {std::move(light), std::move(scene), std::move(table), std::move(report), method};
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
                  true, [options, &shared, &app] {
                    const ThreadLimit limit(shared.threads);
                    image(*options, *app.get_subcommand("image"), shared);
                  });
  options->add_to(*command);
}

}  // namespace petzval::app
