// SPDX-License-Identifier: BSD-3-Clause
// petzval lens focus: where the sensor would best stand.
#include <fmt/format.h>
#include <petzval/analysis/best_focus.h>
#include <petzval/analysis/mtf.h>
#include <petzval/base/whole_file.h>
#include <petzval/lens/first_order.h>
#include <petzval/report/analysis_plots.h>

#include <algorithm>
#include <cmath>

#include "analysis_command.h"
#include "lens_commands.h"
#include "table_output.h"

namespace petzval::app {

namespace {

struct FocusCommand : AnalysisCommand {
  double frequency = 40;
};

void focus(const FocusCommand& options, const Shared& shared) {
  const Lens lens = options.prepare(shared);
  const FieldTableRequest request = options.fields.request(lens);
  const BestFocus spot = best_spot_focus(lens, request),
                  mtf = best_mtf_focus(lens, request, options.frequency);
  const double design_mm = lens.surfaces.back().thickness_mm;
  const double paraxial_mm = first_order(lens).paraxial_image_mm - design_mm;
  Table table{{{"focus", "", 0, "focus"},
               {"sensor shift", "mm", 5, "sensor_shift_mm"},
               {"image distance", "mm", 5, "image_distance_mm"},
               {"measure", "", 0, "measure"},
               {"before", "", 4, "before"},
               {"after", "", 4, "after"}},
              {}};
  table.rows.push_back(
      {std::string("paraxial"), paraxial_mm, design_mm + paraxial_mm, std::string(""), NAN, NAN});
  table.rows.push_back({std::string("best-spot"), spot.shift_mm, design_mm + spot.shift_mm,
                        std::string("RMS spot radius [um]"), spot.before, spot.after});
  table.rows.push_back({fmt::format("best-mtf@{:g}", options.frequency), mtf.shift_mm,
                        design_mm + mtf.shift_mm,
                        fmt::format("mean MTF at {:g} cycles/mm", options.frequency), mtf.before, mtf.after});
  if (!options.plot.empty()) {
    MtfOptions through;
    through.frequencies_cpmm = {options.frequency};
    through.weights.assign(request.wavelengths_nm.size(), 1);
    const double reach = 2 * std::max({std::abs(spot.shift_mm), std::abs(mtf.shift_mm),
                                       1 / options.frequency / (2 * first_order(lens).image_space_na)});
    through.sensor_shifts_mm = even_shifts(reach);
    write_whole_file(
        options.plot,
        plot_grid_svg({mtf_focus_plot(request.field_kind, mtf_table(lens, request, through))}, 1, lens.name));
  }
  if (shared.json) {
    nlohmann::ordered_json json = analysis_json(lens, request);
    json["rows"] = rows_json(table);
    return print_json(json);
  }
  fmt::print("{}: places of the sensor, counted from where it is\n", lens.name);
  print_table(table);
}

}  // namespace

void add_lens_focus(CLI::App& lens, Shared& shared) {
  auto options = std::make_shared<FocusCommand>();
  CLI::App* command = add_analysis_command(
      lens, shared, "focus", "Best focus by spot size and by MTF, all fields and wavelengths together",
      "petzval lens focus cooke-triplet --frequency 40 --plot focus.svg", options,
      [](const FocusCommand& chosen, const Shared& all) { focus(chosen, all); });
  command->add_option("--frequency", options->frequency, "Spatial frequency of the MTF [cycles/mm]")
      ->check(positive_number());
}

}  // namespace petzval::app
