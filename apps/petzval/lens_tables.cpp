// SPDX-License-Identifier: BSD-3-Clause
// petzval lens distortion, petzval lens illumination.
#include <fmt/format.h>
#include <petzval/base/whole_file.h>
#include <petzval/report/colours.h>
#include <petzval/report/svg_plot.h>

#include <cmath>

#include "analysis_command.h"
#include "lens_commands.h"
#include "loss_option.h"

namespace petzval::app {

namespace {

struct TableCommand : AnalysisCommand {
  LossChoice losses;  ///< illumination only
};

/// A number by its format, or a dash where there is none.
std::string or_dash(const char* format, double value) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "-";
}

nlohmann::ordered_json table_json(const Lens& lens, const FieldTableRequest& request) {
  return {{"lens", lens.name},
          {"field_definition", field_definition(request.field_kind)},
          {"reference_wavelength_nm", lens.reference_wavelength_nm}};
}

/// Rows [field][wavelength] as one curve a wavelength over `x`.
template <class Row, class X, class Y>
void write_plot(const std::string& path, const std::string& title, Plot plot, const std::vector<Row>& rows,
                std::size_t wavelengths, X&& x, Y&& y) {
  for (std::size_t w = 0; w < wavelengths; ++w) {
    std::vector<double> xs, ys;
    for (std::size_t i = w; i < rows.size(); i += wavelengths) {
      if (!std::isfinite(x(rows[i])) || !std::isfinite(y(rows[i]))) continue;
      xs.push_back(x(rows[i]));
      ys.push_back(y(rows[i]));
    }
    PlotSeries& line = plot.line(fmt::format("{:g} nm", rows[w].wavelength_nm), xs, ys);
    line.colour = wavelength_colour(rows[w].wavelength_nm).hex();
    line.marker = PlotMarker::dot;
  }
  write_whole_file(path, plot_grid_svg({plot}, 1, title));
}

void distortion(const TableCommand& options, const Shared& shared) {
  const Lens read = options.lens.read(shared);
  const Lens lens = options.camera.used(read, options.fields.request(read), shared);
  const FieldTableRequest request = options.fields.request(lens);
  const std::vector<DistortionRow> rows = distortion_table(lens, request);
  if (!options.plot.empty()) {
    Plot plot;
    plot.title = "Distortion";
    plot.x = {"real image height", "mm", PlotScale::linear, {}, {}};
    plot.y = {"distortion", "%", PlotScale::linear, {}, {}};
    write_plot(
        options.plot, lens.name, plot, rows, request.wavelengths_nm.size(),
        [](const DistortionRow& row) { return row.image_height_mm; },
        [](const DistortionRow& row) { return row.distortion_percent; });
  }
  if (shared.json) {
    nlohmann::ordered_json json = table_json(lens, request);
    json["rows"] = nlohmann::ordered_json::array();
    for (const DistortionRow& row : rows)
      json["rows"].push_back(
          {{"field", row.field},
           {"wavelength_nm", row.wavelength_nm},
           {"image_height_mm", number_or_null(row.image_height_mm)},
           {"distortion_percent", number_or_null(row.distortion_percent)},
           {"distortion_ftheta_percent", number_or_null(row.distortion_ftheta_percent.value_or(NAN))},
           {"paraxial_image_height_mm", number_or_null(row.paraxial_image_height_mm)},
           {"lit", row.lit},
           {lens.object_distance_mm ? "object_height_mm" : "object_angle_deg", row.object_field}});
    return print_json(json);
  }
  fmt::print("{}: distortion against the paraxial image height\n", lens.name);
  fmt::print("{:>28} {:>15} {:>18} {:>22} {:>15}\n", field_heading(request.field_kind), "wavelength [nm]",
             "image height [mm]", "paraxial height [mm]", "distortion [%]");
  for (const DistortionRow& row : rows)
    if (row.lit)
      fmt::print("{:>28g} {:>15g} {:>18.6f} {:>22} {:>15}\n", row.field, row.wavelength_nm,
                 row.image_height_mm, or_dash("{:.6f}", row.paraxial_image_height_mm),
                 or_dash("{:.4f}", row.distortion_percent));
    else
      fmt::print("{:>28g} {:>15g} {:>18}\n", row.field, row.wavelength_nm, "no ray passes");
}

void illumination(const TableCommand& options, const Shared& shared) {
  const Lens lens = options.prepare(shared);
  FieldTableRequest request = options.fields.request(lens);
  request.losses = options.losses.losses(lens, shared);
  const std::vector<IlluminationRow> rows = illumination_table(lens, request);
  for (const IlluminationRow& row : rows)
    if (!row.pupil_in_one_piece)
      note(shared,
           fmt::format("at field {:g} and {:g} nm the pupil has a hole or falls into parts; g_sensor counts "
                       "what lies around the chief ray, holes filled",
                       row.field, row.wavelength_nm));
  if (!options.plot.empty()) {
    Plot plot;
    plot.title = "Relative illumination";
    plot.x = {"real image height", "mm", PlotScale::linear, {}, {}};
    plot.y = {"g_sensor / g_sensor on axis", "", PlotScale::linear, 0.0, {}};
    write_plot(
        options.plot, lens.name, plot, rows, request.wavelengths_nm.size(),
        [](const IlluminationRow& row) { return row.real_image_height_mm; },
        [](const IlluminationRow& row) { return row.relative_illumination; });
  }
  if (shared.json) {
    nlohmann::ordered_json json = table_json(lens, request);
    json["rows"] = nlohmann::ordered_json::array();
    for (const IlluminationRow& row : rows)
      json["rows"].push_back(
          {{"field", row.field},
           {"wavelength_nm", row.wavelength_nm},
           {"real_image_height_mm", number_or_null(row.real_image_height_mm)},
           {"lit", row.lit},
           {"pupil_in_one_piece", row.pupil_in_one_piece},
           {"g_sensor_sr", row.g_sensor_sr},
           {"g_source_sr", row.g_source_sr},
           {"relative_illumination", row.relative_illumination},
           {lens.object_distance_mm ? "object_height_mm" : "object_angle_deg", row.object_field}});
    return print_json(json);
  }
  fmt::print("{}: irradiance per radiance at the sensor (g_sensor) and per source point (g_source)\n",
             lens.name);
  fmt::print("{:>28} {:>15} {:>18} {:>14} {:>14} {:>22}\n", field_heading(request.field_kind),
             "wavelength [nm]", "image height [mm]", "g_sensor [sr]", "g_source [sr]",
             "relative illumination");
  for (const IlluminationRow& row : rows) {
    if (!row.lit) {
      fmt::print("{:>28g} {:>15g} {:>18}\n", row.field, row.wavelength_nm, "no ray passes");
      continue;
    }
    fmt::print("{:>28g} {:>15g} {:>18.6f} {:>14.6f} {:>14.6f} {:>22.5f}\n", row.field, row.wavelength_nm,
               row.real_image_height_mm, row.g_sensor_sr, row.g_source_sr, row.relative_illumination);
  }
}

}  // namespace

void add_lens_distortion(CLI::App& lens, Shared& shared) {
  add_analysis_command(lens, shared, "distortion", "Real and paraxial image heights by field and wavelength",
                       "petzval lens distortion edmund-54852 --fields 0,2.1,3 --wavelengths 587.56",
                       std::make_shared<TableCommand>(), distortion);
}

void add_lens_illumination(CLI::App& lens, Shared& shared) {
  auto options = std::make_shared<TableCommand>();
  CLI::App* command = add_analysis_command(
      lens, shared, "illumination", "Absolute and relative illumination by field and wavelength",
      "petzval lens illumination edmund-54852 --plot illumination.svg", options, illumination);
  options->losses.add_to(*command);
}

}  // namespace petzval::app
