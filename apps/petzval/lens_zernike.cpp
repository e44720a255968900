// SPDX-License-Identifier: BSD-3-Clause
// petzval lens zernike: wavefronts as sums of Zernike polynomials.
#include <fmt/format.h>
#include <petzval/analysis/wavefront_zernike.h>
#include <petzval/base/whole_file.h>
#include <petzval/report/pupil_plots.h>

#include "analysis_command.h"
#include "lens_commands.h"
#include "table_output.h"

namespace petzval::app {

namespace {

struct ZernikeCommand : AnalysisCommand {
  std::string order = "fringe";
  int terms = 0;
};

void zernike(const ZernikeCommand& options, const Shared& shared) {
  const Lens lens = options.prepare(shared);
  const FieldTableRequest request = options.fields.request(lens);
  const ZernikeOrder order = options.order == "noll" ? ZernikeOrder::noll : ZernikeOrder::fringe;
  const int terms = options.terms > 0 ? options.terms : order == ZernikeOrder::noll ? 36 : 37;
  const std::vector<WavefrontZernikeRow> rows = zernike_table(lens, request, order, terms);
  if (!options.plot.empty())
    write_whole_file(options.plot,
                     plot_grid_svg({zernike_plot(request.field_kind, rows, order)}, 1, lens.name));
  const Table table = tabulate(request.field_kind, rows, order);
  if (shared.json) {
    nlohmann::ordered_json json = analysis_json(lens, request);
    json["order"] = options.order;
    json["normalisation"] =
        order == ZernikeOrder::noll ? "mean square 1 over the disc" : "1 in size at the rim";
    json["rows"] = rows_json(table);
    json["residuals"] = nlohmann::ordered_json::array();
    for (const WavefrontZernikeRow& row : rows)
      json["residuals"].push_back({{"field", row.field},
                                   {"wavelength_nm", row.wavelength_nm},
                                   {"real_image_height_mm", row.real_image_height_mm},
                                   {"rms_residual_waves", row.rms_residual_waves}});
    return print_json(json);
  }
  fmt::print("{}: wavefront over the stop in {} {} Zernike terms\n", lens.name, terms, options.order);
  print_table(table);
  for (const WavefrontZernikeRow& row : rows)
    fmt::print("left at {:g} {} and {:g} nm: {:.3g} waves RMS\n", row.field, field_unit(request.field_kind),
               row.wavelength_nm, row.rms_residual_waves);
}

}  // namespace

void add_lens_zernike(CLI::App& lens, Shared& shared) {
  auto options = std::make_shared<ZernikeCommand>();
  CLI::App* command = add_analysis_command(
      lens, shared, "zernike", "The wavefront as Zernike polynomials, Noll or Fringe",
      "petzval lens zernike cooke-triplet --wavelengths 550 --order noll --terms 15 --plot zernike.svg",
      options, [](const ZernikeCommand& chosen, const Shared& all) { zernike(chosen, all); });
  command->add_option("--order", options->order, "Which set: fringe (rim 1) or noll (RMS 1)")
      ->check(CLI::IsMember({"fringe", "noll"}));
  command->add_option("--terms", options->terms, "How many terms; default: 37 of Fringe, 36 of Noll")
      ->check(CLI::Range(1, 231));
}

}  // namespace petzval::app
