// SPDX-License-Identifier: BSD-3-Clause
// petzval lens spots: spot sizes and spot diagrams.
#include <fmt/format.h>
#include <petzval/analysis/field_rows.h>
#include <petzval/analysis/spots.h>
#include <petzval/base/units.h>
#include <petzval/base/whole_file.h>
#include <petzval/report/colours.h>
#include <petzval/report/svg_plot.h>

#include <algorithm>
#include <cmath>

#include "analysis_command.h"
#include "lens_commands.h"

namespace petzval::app {

namespace {

struct SpotsCommand : AnalysisCommand {
  bool by_light = false;
};

/// Rings of rays in a spot diagram: 3·8·9 = 216 points.
constexpr int diagram_rings = 8;

struct Diagram {
  double field = 0, wavelength_nm = 0;
  std::vector<double> x_um, y_um;  ///< from the chief ray's point of the same wavelength
  double height_um = 0;            ///< of that point
};

std::vector<Diagram> diagrams(const Lens& lens, const FieldTableRequest& request) {
  return field_rows<Diagram>(lens, request,
                             [](const FieldTracer& tracer, const ChiefRay& chief) -> std::optional<Diagram> {
                               Diagram diagram;
                               diagram.height_um = chief.image_height_mm * um_per_mm;
                               for (const PupilRay& ray : ring_rays(tracer, chief, diagram_rings)) {
                                 diagram.x_um.push_back(ray.x_mm * um_per_mm);
                                 diagram.y_um.push_back(ray.y_mm * um_per_mm);
                               }
                               return diagram;
                             });
}

void draw_circle(Plot& plot, double x, double y, double radius) {
  std::vector<double> xs, ys;
  constexpr int steps = 72;
  for (int i = 0; i <= steps; ++i) {
    xs.push_back(x + radius * std::cos(2 * pi * i / steps));
    ys.push_back(y + radius * std::sin(2 * pi * i / steps));
  }
  PlotSeries& circle = plot.line("", xs, ys);
  circle.colour = "#000000";
  circle.width_px = 1.2;
}

/// Fields side by side, each about the chief ray of its first wavelength, with that wavelength's Airy circle.
void write_plot(const std::string& path, const Lens& lens, const FieldTableRequest& request,
                const std::vector<SpotRow>& rows) {
  const std::vector<Diagram> all = diagrams(lens, request);
  const std::size_t wavelengths = request.wavelengths_nm.size();
  const auto above_um = [&](std::size_t i) {
    return all[i].height_um - all[i - i % wavelengths].height_um;  // lateral colour
  };
  double reach = 0;
  for (std::size_t i = 0; i < rows.size(); ++i)
    reach = std::max({reach, rows[i].airy_radius_um,
                      rows[i].max_radius_um + std::abs(rows[i].centroid_um) + std::abs(above_um(i))});
  Plot plot;
  plot.title = lens.name + ": spots and Airy circle";
  plot.x = {"sagittal, fields side by side", "µm"};
  plot.y = {"from the chief ray", "µm"};
  plot.y.from = -1.3 * reach;
  plot.y.to = 1.1 * reach;
  plot.equal_aspect = true;
  plot.width_px = 1000;
  const double pitch = 2.2 * reach;
  constexpr double stroke_px = 1.3;
  const double stroke = stroke_px * pitch * static_cast<double>(request.fields.size()) / plot.width_px;
  for (std::size_t w = 0; w < wavelengths; ++w) {
    std::vector<double> xs, ys;
    for (std::size_t f = 0; f < request.fields.size(); ++f) {
      const Diagram& diagram = all[f * wavelengths + w];
      for (std::size_t k = 0; k < diagram.x_um.size(); ++k) {
        // A stroke as short as it is thick: markers of the plot would hide each other.
        const double x = diagram.x_um[k] + pitch * static_cast<double>(f);
        const double y = diagram.y_um[k] + above_um(f * wavelengths + w);
        xs.insert(xs.end(), {x - 0.5 * stroke, x + 0.5 * stroke, std::nan("")});
        ys.insert(ys.end(), {y, y, y});
      }
    }
    PlotSeries& dots = plot.line(fmt::format("{:g} nm", request.wavelengths_nm[w]), xs, ys);
    dots.colour = wavelength_colour(request.wavelengths_nm[w]).hex();
    dots.width_px = stroke_px;
  }
  for (std::size_t f = 0; f < request.fields.size(); ++f) {
    const double x = pitch * static_cast<double>(f);
    draw_circle(plot, x, 0, rows[f * wavelengths].airy_radius_um);
    plot.notes.push_back({x - 0.9 * reach, -1.15 * reach,
                          fmt::format("{:g} {}", request.fields[f], field_unit(request.field_kind))});
  }
  write_whole_file(path, plot.svg());
}

void spots(const SpotsCommand& options, const Shared& shared) {
  const Lens lens = options.fields.prepare(options.lens.read(shared), shared);
  const FieldTableRequest request = options.fields.request(lens);
  const std::vector<SpotRow> rows =
      spot_table(lens, request, options.by_light ? RayWeight::light : RayWeight::stop_area);
  if (!options.plot.empty()) write_plot(options.plot, lens, request, rows);
  if (shared.json) {
    nlohmann::ordered_json json = analysis_json(lens, request);
    for (const SpotRow& row : rows)
      json["rows"].push_back({{"field", row.field},
                              {"wavelength_nm", row.wavelength_nm},
                              {"real_image_height_mm", row.real_image_height_mm},
                              {"centroid_um", row.centroid_um},
                              {"rms_radius_um", row.rms_radius_um},
                              {"rms_x_um", row.rms_x_um},
                              {"rms_y_um", row.rms_y_um},
                              {"max_radius_um", row.max_radius_um},
                              {"airy_radius_um", row.airy_radius_um}});
    return print_json(json);
  }
  fmt::print("{}: spot radii about the centroid, rays weighted by {}\n", lens.name,
             options.by_light ? "their light" : "area on the stop");
  fmt::print("{:>28} {:>15} {:>18} {:>14} {:>9} {:>11} {:>11} {:>9} {:>10}\n",
             field_heading(request.field_kind), "wavelength [nm]", "image height [mm]", "centroid [um]",
             "RMS [um]", "RMS x [um]", "RMS y [um]", "max [um]", "Airy [um]");
  for (const SpotRow& row : rows)
    fmt::print("{:>28g} {:>15g} {:>18.6f} {:>14.4f} {:>9.4f} {:>11.4f} {:>11.4f} {:>9.4f} {:>10.4f}\n",
               row.field, row.wavelength_nm, row.real_image_height_mm, row.centroid_um, row.rms_radius_um,
               row.rms_x_um, row.rms_y_um, row.max_radius_um, row.airy_radius_um);
}

}  // namespace

void add_lens_spots(CLI::App& lens, Shared& shared) {
  auto options = std::make_shared<SpotsCommand>();
  CLI::App* command =
      add_analysis_command(lens, shared, "spots", "Spot sizes by field and wavelength, and spot diagrams",
                           "petzval lens spots cooke-triplet --plot spots.svg", options,
                           [](const SpotsCommand& chosen, const Shared& all) { spots(chosen, all); });
  command->add_flag("--by-light", options->by_light,
                    "Weight rays by the light they carry, not by their area on the stop");
}

}  // namespace petzval::app
