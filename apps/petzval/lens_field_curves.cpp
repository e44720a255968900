// SPDX-License-Identifier: BSD-3-Clause
// petzval lens field-curvature, colour, vignetting, chief-ray-angle: curves over the field.
#include <fmt/format.h>
#include <petzval/base/whole_file.h>
#include <petzval/report/analysis_plots.h>

#include "analysis_command.h"
#include "lens_commands.h"
#include "table_output.h"

namespace petzval::app {

namespace {

/// Fields of a curve in a plot.
constexpr int smooth_fields = 41;

/// The same request at so many fields that curves are smooth.
FieldTableRequest dense(FieldTableRequest request) {
  request.fields = even_fields(request.fields, smooth_fields);
  return request;
}

void print(const Shared& shared, const Lens& lens, const FieldTableRequest& request, const std::string& title,
           const Table& table) {
  if (shared.json) {
    nlohmann::ordered_json json = analysis_json(lens, request);
    json["rows"] = rows_json(table);
    return print_json(json);
  }
  fmt::print("{}: {}\n", lens.name, title);
  print_table(table);
}

void write_plot(const std::string& path, const Plot& plot, const Lens& lens) {
  write_whole_file(path, plot_grid_svg({plot}, 1, lens.name));
}

void field_curvature(const AnalysisCommand& options, const Shared& shared) {
  const Lens lens = options.prepare(shared);
  const FieldTableRequest request = options.fields.request(lens);
  if (!options.plot.empty())
    write_plot(options.plot,
               field_curvature_plot(request.field_kind, field_curvature_table(lens, dense(request))), lens);
  print(shared, lens, request, "foci beside the real chief ray, from the image surface along z",
        tabulate(request.field_kind, field_curvature_table(lens, request)));
}

void vignetting(const AnalysisCommand& options, const Shared& shared) {
  const Lens lens = options.prepare(shared);
  const FieldTableRequest request = options.fields.request(lens);
  if (!options.plot.empty())
    write_plot(options.plot, vignetting_plot(request.field_kind, vignetting_table(lens, dense(request))),
               lens);
  print(shared, lens, request, "what each field's light fills of the stop, in stop radii",
        tabulate(request.field_kind, vignetting_table(lens, request)));
}

void chief_ray_angle(const AnalysisCommand& options, const Shared& shared) {
  const Lens lens = options.prepare(shared);
  const FieldTableRequest request = options.fields.request(lens);
  if (!options.plot.empty())
    write_plot(options.plot, chief_ray_angle_plot(chief_ray_angle_table(lens, dense(request))), lens);
  print(shared, lens, request, "angle at the sensor, positive away from the axis",
        tabulate(request.field_kind, chief_ray_angle_table(lens, request)));
}

void colour(const AnalysisCommand& options, const Shared& shared) {
  const Lens lens = options.prepare(shared);
  const FieldTableRequest request = options.fields.request(lens);
  if (!options.plot.empty()) {
    const std::vector<double> zones = even_fields({1.0}, smooth_fields);
    Plot axial = longitudinal_plot(axial_focus_table(lens, request.wavelengths_nm, zones, request.clip));
    Plot lateral = lateral_colour_plot(request.field_kind, lateral_colour_table(lens, dense(request)));
    write_whole_file(options.plot, plot_grid_svg({axial, lateral}, 2, lens.name + ": colour"));
  }
  const Table axial = tabulate(axial_focus_table(lens, request.wavelengths_nm, {0, 0.7, 1}, request.clip));
  const Table lateral = tabulate(request.field_kind, lateral_colour_table(lens, request));
  if (shared.json) {
    nlohmann::ordered_json json = analysis_json(lens, request);
    json["rows"] = rows_json(lateral);
    json["axial_rows"] = rows_json(axial);
    return print_json(json);
  }
  fmt::print("{}: where rays of the axial point cross the axis, from the image surface; zone 0: paraxial\n",
             lens.name);
  print_table(axial);
  fmt::print("\nHeight of the chief ray, less that of {:g} nm\n", lens.reference_wavelength_nm);
  print_table(lateral);
}

}  // namespace

void add_lens_field_curvature(CLI::App& lens, Shared& shared) {
  add_analysis_command(lens, shared, "field-curvature",
                       "Tangential and sagittal foci beside the real chief ray, and the Petzval curve",
                       "petzval lens field-curvature double-gauss --plot curves.svg",
                       std::make_shared<AnalysisCommand>(), field_curvature);
}

void add_lens_colour(CLI::App& lens, Shared& shared) {
  add_analysis_command(lens, shared, "colour", "Axial and lateral colour of real rays",
                       "petzval lens colour cooke-triplet --plot colour.svg",
                       std::make_shared<AnalysisCommand>(), colour);
}

void add_lens_vignetting(CLI::App& lens, Shared& shared) {
  add_analysis_command(lens, shared, "vignetting",
                       "How much of the stop each field fills, and which surfaces take the rest",
                       "petzval lens vignetting dgauss-50mm --plot vignetting.svg",
                       std::make_shared<AnalysisCommand>(), vignetting);
}

void add_lens_chief_ray_angle(CLI::App& lens, Shared& shared) {
  add_analysis_command(lens, shared, "chief-ray-angle", "At what angle the light meets the sensor",
                       "petzval lens chief-ray-angle edmund-54852 --plot angle.svg",
                       std::make_shared<AnalysisCommand>(), chief_ray_angle);
}

}  // namespace petzval::app
