// SPDX-License-Identifier: BSD-3-Clause
// petzval lens fans: ray fans and OPD fans.
#include <fmt/format.h>
#include <petzval/analysis/aberration_fans.h>
#include <petzval/base/whole_file.h>
#include <petzval/report/pupil_plots.h>

#include "analysis_command.h"
#include "lens_commands.h"
#include "table_output.h"

namespace petzval::app {

namespace {

struct FansCommand : AnalysisCommand {
  int rays = 21;
  bool opd = false;
};

/// Rays a fan of a plot has at least, so that its curves are smooth.
constexpr int smooth = 81;

void fans(const FansCommand& options, const Shared& shared) {
  const Lens lens = options.prepare(shared);
  const FieldTableRequest request = options.fields.request(lens);
  if (!options.plot.empty()) {
    const std::vector<AberrationFans> curves = aberration_fans(lens, request, std::max(smooth, options.rays));
    const FanQuantity quantity = options.opd ? FanQuantity::opd : FanQuantity::transverse;
    write_whole_file(options.plot,
                     plot_grid_svg(fan_plots(request.field_kind, curves, quantity), 2,
                                   fmt::format("{}: {}", lens.name, options.opd ? "OPD fans" : "ray fans")));
  }
  const Table table = tabulate(request.field_kind, aberration_fans(lens, request, options.rays));
  if (shared.json) {
    nlohmann::ordered_json json = analysis_json(lens, request);
    json["rows"] = rows_json(table);
    return print_json(json);
  }
  fmt::print("{}: rays across the stop, from the chief ray of {:g} nm\n", lens.name,
             lens.reference_wavelength_nm);
  print_table(table);
}

}  // namespace

void add_lens_fans(CLI::App& lens, Shared& shared) {
  auto options = std::make_shared<FansCommand>();
  CLI::App* command =
      add_analysis_command(lens, shared, "fans", "Ray fans and OPD fans, tangential and sagittal",
                           "petzval lens fans cooke-triplet --rays 11 --plot fans.svg", options,
                           [](const FansCommand& chosen, const Shared& all) { fans(chosen, all); });
  command->add_option("--rays", options->rays, "Rays a fan")->check(CLI::Range(3, 100001));
  command->add_flag("--opd", options->opd, "Plot the wavefront instead of the transverse aberration");
}

}  // namespace petzval::app
