// SPDX-License-Identifier: BSD-3-Clause
// petzval focus: the film distance at which a scene is sharpest.
#include <fmt/format.h>
#include <petzval/base/whole_file.h>
#include <petzval/lens/lens_file.h>
#include <petzval/report/svg_plot.h>

#include <algorithm>

#include "field_option.h"
#include "scene_focus.h"

namespace petzval::app {

namespace {

struct FocusCommand {
  RenderChoice choice;
  FocusChoice focus;
  std::string plot;
};

void draw(const FocusResult& result, const std::string& title, const std::string& path) {
  std::vector<FocusEvaluation> sorted = result.evaluations;
  std::sort(sorted.begin(), sorted.end(), [](const FocusEvaluation& a, const FocusEvaluation& b) {
    return a.film_distance_mm < b.film_distance_mm;
  });
  std::vector<double> x, y;
  for (const FocusEvaluation& each : sorted) {
    x.push_back(each.film_distance_mm);
    y.push_back(each.measure / result.measure);
  }
  Plot plot;
  plot.title = title;
  plot.x = {"film distance", "mm"};
  plot.y = {"focus measure / largest", ""};
  plot.y.from = 0;
  PlotSeries& line = plot.line("", x, y);
  line.marker = PlotMarker::circle;
  plot.guides.push_back(
      {PlotGuide::At::x, result.film_distance_mm, fmt::format("{:.4f} mm", result.film_distance_mm)});
  write_whole_file(path, plot.svg());
}

void print(const FocusResult& result, const std::string& measure) {
  fmt::print("  film distance [mm]     {:>8} measure  stage\n", measure);
  for (const FocusEvaluation& each : result.evaluations)
    fmt::print("  {:>18.4f}  {:>16.6g}  {}\n", each.film_distance_mm, each.measure, each.stage);
  fmt::print("film distance {:.4f} mm, after {} evaluations\n", result.film_distance_mm,
             result.evaluations.size());
}

nlohmann::ordered_json to_json(const FocusResult& result, const FocusCommand& command) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const FocusEvaluation& each : result.evaluations)
    rows.push_back(
        {{"film_distance_mm", each.film_distance_mm}, {"measure", each.measure}, {"stage", each.stage}});
  return {{"scene", command.choice.scene},    {"film_distance_mm", result.film_distance_mm},
          {"measure", command.focus.measure}, {"search", command.focus.search},
          {"at_the_end", result.at_the_end},  {"rows", rows}};
}

void focus(const FocusCommand& command, const Shared& shared) {
  if (!command.plot.empty()) require_extension(command.plot, {".svg"}, "a plot");
  const PreparedScene scene = prepare_scene(command.choice, focus_wavelengths_nm(), shared);
  const FocusResult result = autofocus(scene, command.focus, shared);
  if (result.at_the_end)
    note(shared,
         "the sharpest place lies at an end of the distances searched; --focus-from and --focus-to widen "
         "them");
  if (!command.plot.empty()) draw(result, scene.camera.lens->name, command.plot);
  if (shared.json) return print_json(to_json(result, command));
  print(result, command.focus.measure);
}

}  // namespace

void add_focus_command(CLI::App& app, Shared& shared) {
  auto options = std::make_shared<FocusCommand>();
  CLI::App* command =
      add_command(app, shared, "focus", "Find the film distance at which a scene is sharpest",
                  "petzval focus spheres --lens dgauss-50mm --size 120x90 --zone 0.3,0.5,0.4,0.7 --plot "
                  "focus.svg",
                  true, [options, &shared] { focus(*options, shared); });
  options->choice.add_to(*command);
  command->add_option("--zones", options->focus.zones_file,
                      "A file of zones: left right top bottom, in fractions of the film, a line each");
  command->add_option("--zone", options->focus.zones, "One zone: left,right,top,bottom (repeatable)")
      ->take_all()
      ->allow_extra_args(false);
  options->focus.add_to(*command);
  command->add_option("--plot", options->plot, "Draw the evaluations into this SVG file");
}

}  // namespace petzval::app
