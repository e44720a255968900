// SPDX-License-Identifier: BSD-3-Clause
// The section of a lens report about where the light of a point goes.
#include <fmt/format.h>
#include <petzval/analysis/field_values.h>
#include <petzval/analysis/point_spread.h>
#include <petzval/base/error.h>
#include <petzval/report/analysis_plots.h>
#include <petzval/report/field_curves.h>
#include <petzval/report/heat_map.h>
#include <petzval/report/report_section.h>

#include <algorithm>

namespace petzval {

namespace {

/// Cells a side of the frames, and the light that the widest of them must hold.
constexpr int frame_cells = 64;
constexpr double frame_share = 0.95;
constexpr double frame_px = 200;

struct FieldPsf {
  double field;
  Psf psf;
};

/// PSFs of all fields in frames of one width: that of the widest.
std::vector<FieldPsf> psfs_in_one_scale(const ReportLens& report) {
  const Lens& lens = report.lens;
  FieldTracer tracer(lens, lens.reference_wavelength_nm, report.request.clip, report.request.azimuth_deg);
  PsfOptions options;
  options.size = frame_cells;
  options.wanted_share = frame_share;
  std::vector<FieldPsf> psfs;
  double widest_um = 0;
  const auto all = [&] {
    psfs.clear();
    for (const double field : report.request.fields) {
      const auto chief = tracer.chief_ray(object_field(lens, report.request.field_kind, field));
      const std::optional<Psf> psf = chief ? point_spread(tracer, *chief, options) : std::nullopt;
      if (!psf) throw InputError(fmt::format("{}: no ray passes at field {:g}", lens.name, field));
      widest_um = std::max(widest_um, psf->spacing_um);
      psfs.push_back({field, *psf});
    }
  };
  all();
  options.spacing_um = widest_um;
  all();
  return psfs;
}

Table psf_data(Fields::Kind kind, const std::vector<FieldPsf>& psfs) {
  Table table{{{"field", field_unit(kind), 3, "field"},
               {"s", "µm", 4, "s_um"},
               {"t", "µm", 4, "t_um"},
               {"share of the light", "", 8, "light"}},
              {}};
  for (const FieldPsf& each : psfs)
    for (int i = 0; i < each.psf.size; ++i)
      for (int j = 0; j < each.psf.size; ++j)
        table.rows.push_back({each.field, (j - each.psf.size / 2) * each.psf.spacing_um,
                              (i - each.psf.size / 2) * each.psf.spacing_um,
                              each.psf.at(i, j) * each.psf.captured});
  return table;
}

}  // namespace

void add_light_spread_section(html::Page& page, const ReportLens& report, const std::string& title_end) {
  const Fields::Kind kind = report.request.field_kind;
  const double wavelength_nm = report.lens.reference_wavelength_nm;
  const std::vector<FieldPsf> psfs = psfs_in_one_scale(report);
  std::vector<StripFrame> frames;
  for (const FieldPsf& each : psfs) {
    HeatMapOptions map;
    map.gamma = 2;
    map.first_row_on_top = false;  // t points up, away from the axis
    frames.push_back(
        {heat_map_png(each.psf.values, each.psf.size, each.psf.size, map),
         fmt::format("{}\n{:.1f} % of the light", field_text(kind, each.field), 100 * each.psf.captured)});
  }
  ImageStripOptions strip;
  strip.frame_px = frame_px;
  strip.frames_per_row = 4;
  strip.frame_width = 2 * psfs.front().psf.half_width_um();
  strip.unit = "µm";
  page.section("Point spread and encircled energy" + title_end, "point spread" + title_end);
  page.add(figure_with_data(
      image_strip_svg(frames, strip, "Point-spread functions, square-root scale"),
      fmt::format(
          "Diffraction PSFs at {:g} nm by plane waves of real rays, each to its own peak on a square-root "
          "scale; the chief ray in the middle, up is away from the axis.",
          wavelength_nm),
      "psf.csv", psf_data(kind, psfs)));
  FieldTableRequest request = report.request;
  request.wavelengths_nm = {wavelength_nm};
  const std::vector<EncircledEnergyRow> energy = encircled_energy_table(report.lens, request);
  page.add(figure_with_data(
      encircled_energy_plot(kind, energy).svg(),
      fmt::format(
          "Share of the light within a circle about the centroid at {:g} nm; dashed: an Airy pattern of "
          "the same pupil.",
          wavelength_nm),
      "encircled_energy.csv", tabulate(kind, energy)));
}

}  // namespace petzval
