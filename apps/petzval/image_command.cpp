// SPDX-License-Identifier: BSD-3-Clause
// petzval image: a planar scene through a lens, onto a sensor.
#include <fmt/format.h>
#include <petzval/scene/scene_file.h>
#include <petzval/simulate/image_pieces.h>

#include <memory>
#include <span>
#include <utility>

#include "field_option.h"
#include "image_option.h"
#include "image_output.h"

namespace petzval::app {

namespace {

/// Some bands of the image, into their checkpoint: what the command would write waits for all of them.
void form_piece(const ImagePlan& plan, const Context& context, const Shared& shared) {
  const auto [first, end] = *plan.options.bands;
  image_piece(plan, context);
  if (shared.json)
    return print_json({{"columns", plan.frame.columns},
                       {"rows", plan.frame.rows},
                       {"bands", {first, end}},
                       {"checkpoint", plan.options.checkpoint}});
  if (!shared.quiet)
    fmt::print("{}: {} of {} bands of {} x {} pixels\n", plan.options.checkpoint, end - first,
               plan.scene.bands(), plan.frame.columns, plan.frame.rows);
}

void run_image(const ImageChoice& choice, const CLI::App& app, const Shared& shared) {
  const Context context = context_of(shared);
  Optics optics = choice.read_optics(shared);
  const std::optional<Sensor> sensor = std::visit([](const auto& camera) { return camera.sensor; }, optics);
  OutputOptions outputs = choice.shot.checked(sensor, choice.outputs, app);

  FormedImage formed;
  formed.plan = plan_image(choice.scene.request(), std::move(optics), choice.image_options(), context);
  if (choice.image.bands) return form_piece(formed.plan, context, shared);
  formed.file = large_file(choice.outputs, formed.plan);
  if (formed.file)
    image_bands(
        formed.plan, [&](std::span<const float> pixels) { formed.file->bands().add(pixels); }, context,
        &formed.report);
  else
    formed.light = image(formed.plan, context, &formed.report);
  outputs.shown.false_colour = true;
  // The ground of the sky is dark, however faint the stars are.
  constexpr double sky_dark_share = 1e-2;
  if (is_sky_chart(choice.scene.request().name)) outputs.shown.dark_share = sky_dark_share;
  const Outputs made = write_image(choice.outputs, choice.flare, formed, sensor, outputs, context);
  if (shared.json) return print_json(summary_json(formed, made, choice.outputs));
  if (!shared.quiet) print_summary(formed, made);
}

}  // namespace

void add_image_command(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<ImageChoice>();
  CLI::App* command = add_command(
      app, shared, "image", "Image a scene through a lens onto a sensor",
      "petzval image studio --lens edmund-54852 --sensor 320x240@15 -o studio.png "
      "-o studio.exr",
      true, [options, &shared, &app] { run_image(*options, *app.get_subcommand("image"), shared); });
  options->add_to(*command);
}

}  // namespace petzval::app
