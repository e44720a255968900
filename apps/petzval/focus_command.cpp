// SPDX-License-Identifier: BSD-3-Clause
// petzval focus: the film distance at which a scene is sharpest.
#include <fmt/format.h>
#include <petzval/base/error.h>

#include "field_option.h"
#include "focus_output.h"
#include "output_option.h"
#include "plot_output.h"
#include "render_option.h"

namespace petzval::app {

namespace {

struct SceneFocusCommand {
  RenderChoice choice;
  std::string plot;
};

nlohmann::ordered_json to_json(const FocusRun& run, const SceneFocusCommand& command) {
  const FocusResult& result = run.result;
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const FocusEvaluation& each : result.evaluations)
    rows.push_back(
        {{"film_distance_mm", each.film_distance_mm}, {"measure", each.measure}, {"stage", each.stage}});
  const AutofocusChoice& choice = command.choice.autofocus;
  return {{"scene", command.choice.request.scene},
          {"film_distance_mm", result.film_distance_mm},
          {"distance_m", number_or_null(run.distance_m)},
          {"measure", choice.measure},
          {"search", choice.search},
          {"depth_mm", run.depth_mm},
          {"camera_rays", run.camera_rays},
          {"at_the_end", result.at_the_end},
          {"noise", result.noise_share()},
          {"samples_per_pixel", run.samples_per_pixel},
          {"rows", rows}};
}

void focus(const SceneFocusCommand& command, const Shared& shared) {
  if (!command.plot.empty()) require_drawing(command.plot, "a plot");
  if (command.choice.request.scene.empty())
    throw InputError(
        "a scene would be right: a .pbrt, .gltf or .glb file or a name of petzval render --list");
  const RenderRequest request = command.choice.read(shared);
  const FocusRun run = autofocus(request, context_of(shared));
  if (!command.plot.empty()) draw_focus(run, command.plot);
  if (shared.json) return print_json(to_json(run, command));
  fmt::print("{}", focus_text(run, command.choice.autofocus.measure));
}

}  // namespace

void add_focus_command(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<SceneFocusCommand>();
  CLI::App* command =
      add_command(app, shared, "focus", "Find the film distance at which a scene is sharpest",
                  "petzval focus spheres --lens dgauss-50mm --size 120x90 --zone 0.3,0.5,0.4,0.7 --plot "
                  "focus.svg",
                  true, [options, &shared] { focus(*options, shared); });
  options->choice.add_to(*command);
  command->add_option("--zones", options->choice.autofocus.zones_file,
                      "A file of zones: left right top bottom, in fractions of the film, a line each");
  command->add_option("--plot", options->plot, "Draw the evaluations: .svg, .png or .pdf")
      ->check(output_file());
}

}  // namespace petzval::app
