// SPDX-License-Identifier: BSD-3-Clause
// petzval lens mtf: modulation transfer by frequency, field and wavelength.
#include <fmt/format.h>
#include <petzval/analysis/mtf.h>
#include <petzval/base/whole_file.h>
#include <petzval/report/analysis_plots.h>

#include "analysis_command.h"
#include "lens_commands.h"
#include "table_output.h"

namespace petzval::app {

namespace {

struct MtfCommand : AnalysisCommand {
  MtfOptions mtf;
  bool polychromatic = false, as_psf = false, over_field = false;
  std::optional<double> through_focus_mm;
};

/// What the list of frequencies is unless one is given: a grid that shows the shape of the curve.
const std::vector<double> default_frequencies{0, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100};

/// The same where the field or the focus is the axis of the plot.
const std::vector<double> curve_frequencies{10, 20, 40};

std::string wavelength_or_all(double wavelength_nm) {
  return wavelength_nm > 0 ? fmt::format("{:g}", wavelength_nm) : "all";
}

/// Fields of --over-field: from the axis to the largest, evenly.
constexpr int fields_over = 21;

std::string drawn(const MtfCommand& options, const Lens& lens, const FieldTableRequest& request,
                  const std::vector<MtfRow>& rows, std::size_t frequencies) {
  const Plot plot = options.through_focus_mm ? mtf_focus_plot(request.field_kind, rows)
                    : options.over_field     ? mtf_field_plot(request.field_kind, rows, frequencies)
                                             : mtf_plot(request.field_kind, rows, frequencies);
  return plot_grid_svg({plot}, 1, lens.name);
}

void mtf(const MtfCommand& options, const Shared& shared) {
  const Lens lens = options.prepare(shared);
  FieldTableRequest request = options.fields.request(lens);
  MtfOptions chosen = options.mtf;
  const bool curves = options.over_field || options.through_focus_mm;
  if (chosen.frequencies_cpmm.empty())
    chosen.frequencies_cpmm = curves ? curve_frequencies : default_frequencies;
  if (options.over_field) request.fields = even_fields(request.fields, fields_over);
  if (options.through_focus_mm) chosen.sensor_shifts_mm = even_shifts(*options.through_focus_mm);
  if (options.polychromatic && chosen.weights.empty())
    chosen.weights.assign(request.wavelengths_nm.size(), 1);
  if (options.as_psf) chosen.model = {PupilModel::Amplitude::light, PupilModel::Phase::plane_waves};
  const std::vector<MtfRow> rows = mtf_table(lens, request, chosen);
  if (!options.plot.empty())
    write_whole_file(options.plot, drawn(options, lens, request, rows, chosen.frequencies_cpmm.size()));
  if (shared.json) {
    nlohmann::ordered_json json = analysis_json(lens, request);
    json["method"] = chosen.geometric ? "geometric" : "diffraction";
    if (!chosen.weights.empty()) {
      json["wavelengths_nm"] = request.wavelengths_nm;
      json["weights"] = chosen.weights;
    }
    for (const MtfRow& row : rows) {
      json["rows"].push_back(
          {{"field", row.field},
           {"wavelength_nm", row.wavelength_nm > 0 ? nlohmann::ordered_json(row.wavelength_nm)
                                                   : nlohmann::ordered_json(nullptr)},
           {"frequency_cpmm", row.frequency_cpmm},
           {"tangential", row.tangential},
           {"sagittal", row.sagittal}});
      if (options.through_focus_mm) json["rows"].back()["sensor_shift_mm"] = row.sensor_shift_mm;
    }
    return print_json(json);
  }
  if (options.through_focus_mm) return print_table(tabulate(request.field_kind, rows));
  fmt::print("{}: {} MTF\n", lens.name, chosen.geometric ? "geometric" : "diffraction");
  fmt::print("{:>28} {:>15} {:>21} {:>10} {:>8}\n", field_heading(request.field_kind), "wavelength [nm]",
             "frequency [cycles/mm]", "tangential", "sagittal");
  for (const MtfRow& row : rows)
    fmt::print("{:>28g} {:>15} {:>21g} {:>10.4f} {:>8.4f}\n", row.field, wavelength_or_all(row.wavelength_nm),
               row.frequency_cpmm, row.tangential, row.sagittal);
}

}  // namespace

void add_lens_mtf(CLI::App& lens, Shared& shared) {
  auto options = std::make_shared<MtfCommand>();
  CLI::App* command = add_analysis_command(
      lens, shared, "mtf", "Modulation transfer, tangential and sagittal, by frequency, field and wavelength",
      "petzval lens mtf cooke-triplet --frequencies 10,20,40 --polychromatic --plot mtf.svg", options,
      [](const MtfCommand& chosen, const Shared& all) { mtf(chosen, all); });
  command
      ->add_option(
          "--frequencies", options->mtf.frequencies_cpmm,
          "Spatial frequencies on the sensor [cycles/mm], separated by commas; default: 0 to 100 by 10")
      ->delimiter(',')
      ->check(number_not_negative());
  command->add_flag("--polychromatic", options->polychromatic,
                    "All wavelengths together, with equal weights");
  command
      ->add_option("--weights", options->mtf.weights,
                   "All wavelengths together, with these weights, separated by commas: the light of each")
      ->delimiter(',')
      ->check(number_not_negative());
  command->add_flag("--over-field", options->over_field, "At 21 even fields; the plot runs over the field");
  command
      ->add_option(
          "--through-focus", options->through_focus_mm,
          "At 33 places of the sensor up to this far [mm] on both sides of the image surface; the plot "
          "runs over them")
      ->check(positive_number());
  command->add_flag("--geometric", options->mtf.geometric, "Of the rays alone, without diffraction");
  command->add_flag(
      "--as-psf", options->as_psf,
      "The exact transform of `lens psf`; default: an evenly bright pupil on the reference sphere");
}

}  // namespace petzval::app
