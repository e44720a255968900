// SPDX-License-Identifier: BSD-3-Clause
#include "focus_output.h"

#include <fmt/format.h>
#include <petzval/report/svg_plot.h>

#include <algorithm>

#include "plot_output.h"
#include "render_output.h"

namespace petzval::app {

void draw_focus(const FocusRun& run, const std::string& path) {
  const FocusResult& result = run.result;
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
  plot.title = run.lens + run.zones;
  plot.x = {"film distance", "mm"};
  plot.y = {"focus measure / largest", ""};
  plot.y.from = 0;
  PlotSeries& line = plot.line("", x, y);
  line.marker = PlotMarker::circle;
  plot.guides.push_back(
      {PlotGuide::At::x, result.film_distance_mm, fmt::format("{:.4f} mm", result.film_distance_mm)});
  write_drawing(path, plot.svg());
}

std::string focus_text(const FocusRun& run, const std::string& measure) {
  const FocusResult& result = run.result;
  std::string text = fmt::format("  film distance [mm]     {:>8} measure  stage\n", measure);
  for (const FocusEvaluation& each : result.evaluations)
    text += fmt::format("  {:>18.4f}  {:>16.6g}  {}\n", each.film_distance_mm, each.measure, each.stage);
  return text + fmt::format("film distance {:.4f} mm, after {} evaluations: sharp at {}\n",
                            result.film_distance_mm, result.evaluations.size(),
                            rounded_distance_text(run.distance_m));
}

}  // namespace petzval::app
