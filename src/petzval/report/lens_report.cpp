// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/analysis/field_values.h>
#include <petzval/analysis/ray_fan.h>
#include <petzval/analysis/round_stop.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/ray_transfer.h>
#include <petzval/lens/surface_shape.h>
#include <petzval/report/analysis_plots.h>
#include <petzval/report/colours.h>
#include <petzval/report/field_curves.h>
#include <petzval/report/lens_drawing.h>
#include <petzval/report/pupil_plots.h>
#include <petzval/report/report_section.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// Fields of curves, zones of the longitudinal aberration, rays of fans, samples of maps, rings of spots.
constexpr int curve_fields = 33, mtf_fields = 21, curve_zones = 41, fan_rays = 65, map_samples = 64,
              spot_rings = 8;
/// Zernike terms in the table.
constexpr int zernike_terms = 16;

FieldTableRequest dense(FieldTableRequest request, int fields = curve_fields) {
  request.fields = even_fields(request.fields, fields);
  return request;
}

FieldTableRequest at_reference(FieldTableRequest request, const Lens& lens) {
  request.wavelengths_nm = {lens.reference_wavelength_nm};
  return request;
}

std::string length_text(double value_mm) {
  return std::isfinite(value_mm) ? fmt::format("{:.4f}", value_mm) : "infinite";
}

std::string aperture_text(const Aperture& aperture) {
  switch (aperture.kind) {
    case Aperture::Kind::f_number:
      return fmt::format("f/{:g}", aperture.value);
    case Aperture::Kind::working_f_number:
      return fmt::format("working f/{:g}", aperture.value);
    case Aperture::Kind::image_na:
      return fmt::format("image-space NA {:g}", aperture.value);
    case Aperture::Kind::object_na:
      return fmt::format("object-space NA {:g}", aperture.value);
    case Aperture::Kind::entrance_pupil_diameter_mm:
      return fmt::format("entrance pupil {:g} mm", aperture.value);
    case Aperture::Kind::stop_semi_diameter_mm:
      return fmt::format("stop radius {:g} mm", aperture.value);
  }
  return {};
}

html::Block first_order_facts(const Lens& lens, const FirstOrder& data) {
  std::vector<std::string> wavelengths;
  for (const double each : lens.wavelengths_nm) wavelengths.push_back(fmt::format("{:g}", each));
  return html::facts(
      {{"focal length", length_text(data.efl_mm), "mm"},
       {"aperture", aperture_text(lens.aperture)},
       {"f-number (paraxial, infinity)", fmt::format("{:.4f}", data.f_number)},
       {"working f-number", fmt::format("{:.4f}", data.working_f_number)},
       {"field of view", fmt::format("{:.2f}", data.field_of_view_deg), "deg, full"},
       {"object distance", lens.object_distance_mm ? length_text(*lens.object_distance_mm) : "infinite",
        lens.object_distance_mm ? "mm before vertex 1" : ""},
       {"magnification", fmt::format("{:.6f}", data.magnification)},
       {"back focal length", length_text(data.bfl_mm), "mm"},
       {"front focal length", length_text(data.ffl_mm), "mm"},
       {"image distance", length_text(lens.image_distance_mm()), "mm, last vertex to image"},
       {"total track", length_text(data.total_track_mm), "mm"},
       {"entrance pupil", length_text(data.entrance_pupil.position_mm),
        fmt::format("mm from vertex 1, diameter {} mm", length_text(data.entrance_pupil.diameter_mm))},
       {"exit pupil", length_text(data.exit_pupil.position_mm),
        fmt::format("mm from the image, diameter {} mm", length_text(data.exit_pupil.diameter_mm))},
       {"Petzval radius", length_text(data.petzval_radius_mm), "mm"},
       {"wavelengths", fmt::format("{}", fmt::join(wavelengths, ", ")),
        fmt::format("nm, reference {:g} nm", lens.reference_wavelength_nm)}});
}

Table prescription(const Lens& lens) {
  Table table{{{"surface", "", 0},
               {"radius", "mm"},
               {"to next", "mm", 5},
               {"semi-diameter", "mm", 4},
               {"behind it"},
               {"index", "", 6},
               {"remark"}},
              {}};
  for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
    const Surface& surface = lens.surfaces[i];
    const double c = surface.curvature_per_mm;
    std::vector<std::string> remarks;
    if (surface.stop) remarks.push_back("stop");
    if (surface.blades.count > 0)
      remarks.push_back(
          fmt::format("{} blades turned by {:g}°", surface.blades.count, surface.blades.rotation_deg));
    for (std::string& remark : shape_remarks(surface)) remarks.push_back(std::move(remark));
    table.rows.push_back({static_cast<double>(i), c == 0 ? std::string("flat") : cell_text(1 / c, 5),
                          surface.thickness_mm, surface.semi_diameter_mm.value_or(NAN),
                          surface.mirror              ? std::string("mirror")
                          : surface.material.is_air() ? std::string("air")
                                                      : surface.material.description(),
                          lens.medium_behind(i).index(lens.reference_wavelength_nm),
                          fmt::format("{}", fmt::join(remarks, "; "))});
  }
  return table;
}

std::string layout_svg(const ReportLens& report) {
  const Lens& lens = report.lens;
  FieldTracer tracer(lens, lens.reference_wavelength_nm, report.request.clip, report.request.azimuth_deg);
  LensDrawingOptions drawing;
  drawing.azimuth_deg = report.request.azimuth_deg;
  std::vector<DrawnRay> rays;
  for (std::size_t i = 0; i < report.request.fields.size(); ++i) {
    const double field = object_field(lens, report.request.field_kind, report.request.fields[i]);
    const std::string colour = series_colour(i).hex();
    constexpr int rays_a_field = 5;
    for (const MeridionalPath& path :
         meridional_fan(tracer, field, rays_a_field, 0.25 * lens.total_track_mm()))
      rays.push_back({path, colour});
    drawing.legend.push_back({field_text(report.request.field_kind, report.request.fields[i]), colour});
  }
  return draw_lens(lens, rays, drawing);
}

/// The sections about one lens.
class LensSections {
 public:
  LensSections(html::Page& page, const ReportLens& report, const LensReportOptions& options, bool alone)
      : page_(page),
        lens_(report.lens),
        report_(report),
        request_(report.request),
        kind_(report.request.field_kind),
        options_(options),
        end_(alone ? "" : " — " + report.lens.name) {}

  void add_all() {
    overview();
    spots();
    fans();
    wavefronts();
    field_curves();
    colour();
    add_light_spread_section(page_, report_, end_);
    transfer();
    light();
    third_order();
    zernikes();
    if (options_.sensor) add_sensor_section(page_, report_, *options_.sensor, end_);
  }

 private:
  void section(const std::string& title, const std::string& contents) {
    page_.section(title + end_, contents + end_);
  }
  void overview() {
    section("Layout and first-order data", "layout");
    page_.add(html::paragraph(lens_.source));
    page_.add(html::figure(html::drawing(layout_svg(report_)),
                           fmt::format("Rays of each field at {:g} nm, rim to rim of what passes; surfaces "
                                       "counted from 0.",
                                       lens_.reference_wavelength_nm)));
    page_.add(html::paragraph(fmt::format("At {:g} nm:", lens_.reference_wavelength_nm)));
    page_.add(first_order_facts(lens_, first_order(lens_)));
    section("Prescription", "prescription");
    const Table table = prescription(lens_);
    page_.add(html::table(table));
    page_.add(html::download("prescription.csv", "text/csv", to_csv(table), "prescription (CSV)"));
  }
  void spots() {
    section("Spots", "spots");
    const std::vector<SpotDiagram> diagrams = spot_diagrams(lens_, request_, spot_rings);
    const std::vector<SpotRow> rows = spot_table(lens_, request_);
    page_.add(figure_with_data(
        plot_grid_svg(spot_plots(kind_, diagrams, rows), spot_plots_across, ""),
        "Spots about the chief ray of the first wavelength, each field on its own scale; circle: Airy disc "
        "of the field. RMS radius about the centroid, rays weighing as their area on the stop.",
        "spot_diagrams.csv", tabulate(kind_, diagrams)));
    page_.add(html::table(tabulate(kind_, rows)));
    page_.add(html::download("spots.csv", "text/csv", to_csv(tabulate(kind_, rows)), "table (CSV)"));
  }
  void fans() {
    section("Ray and OPD fans", "fans");
    const std::vector<AberrationFans> rows = aberration_fans(lens_, request_, fan_rays);
    const Table data = tabulate(kind_, rows);
    page_.add(figure_with_data(plot_grid_svg(fan_plots(kind_, rows, FanQuantity::transverse), 2, ""),
                               "Transverse aberration on the image surface, from the chief ray of the "
                               "reference wavelength, against the height at which a ray crosses the stop.",
                               "fans.csv", data));
    page_.add(html::figure(html::drawing(plot_grid_svg(fan_plots(kind_, rows, FanQuantity::opd), 2, "")),
                           "Wavefront W = (OPL of the chief ray − OPL)/λ on the sphere about the chief ray's "
                           "image point; the data are in the same file."));
  }
  void wavefronts() {
    section("Wavefront", "wavefront");
    if (lens_.stop_blades().count > 0)
      page_.add(
          html::paragraph("Wavefronts and Zernike terms are those of the round stop about the blades."));
    const std::vector<WavefrontMap> maps =
        wavefront_maps(with_round_stop(lens_), at_reference(request_, lens_), map_samples);
    page_.add(figure_with_data(plot_grid_svg(wavefront_map_plots(kind_, maps), 3, ""),
                               "Wavefront over the stop at the reference wavelength, dark to light on one "
                               "scale; grey: no light.",
                               "wavefront_maps.csv", tabulate(kind_, maps)));
    const std::vector<WavefrontRow> rows = wavefront_table(with_round_stop(lens_), request_);
    page_.add(html::table(tabulate(kind_, rows)));
    page_.add(html::download("wavefront.csv", "text/csv", to_csv(tabulate(kind_, rows)), "table (CSV)"));
  }
  void field_curves() {
    section("Longitudinal aberration, field curves, distortion", "field curves");
    const auto axial =
        axial_focus_table(lens_, lens_.wavelengths_nm, even_fields({1.0}, curve_zones), request_.clip);
    const auto curves = field_curvature_table(lens_, dense(request_));
    const auto reference = field_curvature_table(lens_, dense(at_reference(request_, lens_)));
    const auto distortion = distortion_table(lens_, dense(request_));
    page_.add(html::figure(
        html::drawing(plot_grid_svg({longitudinal_plot(axial), field_curvature_plot(kind_, curves, reference),
                                     distortion_plot(kind_, distortion)},
                                    3, "")),
        "Left: where rays of the axial point cross the axis. Middle: tangential (solid) and "
        "sagittal (dashed) foci beside the real chief ray. Right: distortion about the centre of the "
        "picture."));
    page_.add(html::download("longitudinal.csv", "text/csv", to_csv(tabulate(axial)), "longitudinal (CSV)"));
    page_.add(html::download("field_curvature.csv", "text/csv", to_csv(tabulate(kind_, curves)),
                             "field curves (CSV)"));
    page_.add(html::download("distortion.csv", "text/csv", to_csv(tabulate(kind_, distortion)),
                             "distortion (CSV)"));
    page_.add(html::table(tabulate(kind_, field_curvature_table(lens_, at_reference(request_, lens_)))));
    page_.add(html::table(tabulate(kind_, distortion_table(lens_, request_))));
    if (const auto frame = frame_of_fields(lens_)) {
      page_.add(html::paragraph(
          fmt::format("TV distortion of a frame of {:.4g} x {:.4g} mm:", frame->width_mm, frame->height_mm)));
      page_.add(html::table(tabulate(tv_distortion(lens_, *frame, request_.wavelengths_nm))));
      const DistortionGrid grid = distortion_grid(lens_, *frame, lens_.reference_wavelength_nm);
      page_.add(figure_with_data(
          distortion_grid_plot(grid).svg(),
          fmt::format(
              "A square grid over this frame; the crossing farthest off its place is off by {:.3g} % of "
              "the half diagonal.",
              100 * grid.largest_share()),
          "distortion_grid.csv", tabulate(grid)));
    }
  }
  void colour() {
    section("Colour", "colour");
    const auto lateral = lateral_colour_table(lens_, dense(request_));
    page_.add(
        figure_with_data(lateral_colour_plot(kind_, lateral).svg(),
                         "Lateral colour: height of the chief ray less that of the reference wavelength "
                         "from the same object point.",
                         "lateral_colour.csv", tabulate(kind_, lateral)));
    page_.add(html::paragraph("Axial colour by zone of the stop (0: paraxial):"));
    page_.add(
        html::table(tabulate(axial_focus_table(lens_, lens_.wavelengths_nm, {0, 0.7, 1}, request_.clip))));
  }
  void transfer() {
    section("MTF", "MTF");
    MtfOptions options;
    options.weights.assign(request_.wavelengths_nm.size(), 1);
    constexpr int steps = 25;
    for (int i = 0; i <= steps; ++i)
      options.frequencies_cpmm.push_back(options_.highest_frequency_cpmm * i / steps);
    const std::vector<MtfRow> rows = mtf_table(lens_, request_, options);
    page_.add(figure_with_data(
        mtf_plot(kind_, rows, options.frequencies_cpmm.size()).svg(),
        fmt::format("Diffraction MTF of the {} wavelengths together, each of one weight and at its own image "
                    "height.",
                    request_.wavelengths_nm.size()),
        "mtf.csv", tabulate(kind_, rows)));
    MtfOptions by_rays = options;
    by_rays.geometric = true;
    const std::vector<MtfRow> geometric = mtf_table(lens_, request_, by_rays);
    Plot plot = mtf_plot(kind_, geometric, options.frequencies_cpmm.size());
    plot.title = "Geometric MTF, tangential solid, sagittal dashed";
    page_.add(figure_with_data(plot.svg(),
                               "The same by rays alone: the transform of the spots, without diffraction.",
                               "mtf_geometric.csv", tabulate(kind_, geometric)));
    options.frequencies_cpmm = options_.frequencies_cpmm;
    const std::vector<MtfRow> over_field = mtf_table(lens_, dense(request_, mtf_fields), options);
    const double slowest =
        *std::max_element(options.frequencies_cpmm.begin(), options.frequencies_cpmm.end());
    page_.add(figure_with_data(mtf_field_plot(kind_, over_field, options.frequencies_cpmm.size()).svg(),
                               "The same over the field.", "mtf_over_field.csv",
                               tabulate(kind_, over_field)));
    MtfOptions through = options;
    through.frequencies_cpmm = {slowest};
    // A sensor shift that spreads a point over a period and a half of the pattern.
    through.sensor_shifts_mm = even_shifts(1.5 / slowest / (2 * first_order(lens_).image_space_na));
    const std::vector<MtfRow> focus = mtf_table(lens_, request_, through);
    page_.add(figure_with_data(mtf_focus_plot(kind_, focus).svg(),
                               "Through focus: the sensor moved along the axis.", "mtf_through_focus.csv",
                               tabulate(kind_, focus)));
    page_.add(html::table(tabulate(kind_, mtf_table(lens_, request_, options))));
  }
  void light() {
    section("Illumination, vignetting, chief-ray angle", "illumination");
    const auto illumination = illumination_table(lens_, dense(at_reference(request_, lens_)));
    const auto vignetting = vignetting_table(lens_, dense(at_reference(request_, lens_)));
    const auto angles = chief_ray_angle_table(lens_, dense(at_reference(request_, lens_)));
    page_.add(html::side_by_side(
        {figure_with_data(
             illumination_plot(illumination).svg(),
             "Irradiance of a uniform scene against the axis, by all rays that the apertures pass.",
             "illumination.csv", tabulate(kind_, illumination)),
         figure_with_data(vignetting_plot(kind_, vignetting).svg(), "Area of the stop that is filled.",
                          "vignetting.csv", tabulate(kind_, vignetting)),
         figure_with_data(chief_ray_angle_plot(angles).svg(), "Positive away from the axis.",
                          "chief_ray_angle.csv", tabulate(kind_, angles))}));
    page_.add(html::table(tabulate(kind_, illumination_table(lens_, at_reference(request_, lens_)))));
    page_.add(html::table(tabulate(kind_, vignetting_table(lens_, at_reference(request_, lens_)))));
    page_.add(html::table(tabulate(kind_, chief_ray_angle_table(lens_, at_reference(request_, lens_)))));
    if (is_ray_transfer(lens_)) return;
    const auto prints = footprints(lens_, at_reference(request_, lens_));
    page_.add(html::figure(
        html::drawing(plot_grid_svg(footprint_plots(kind_, lens_, prints), footprint_plots_across, "")),
        "Footprints: what each field's light fills of the surfaces, clear apertures and obscurations in "
        "black."));
    page_.add(
        html::download("footprints.csv", "text/csv", to_csv(tabulate(kind_, prints)), "footprints (CSV)"));
  }
  void third_order() {
    const bool has_field = std::any_of(lens_.fields.values.begin(), lens_.fields.values.end(),
                                       [](double field) { return field != 0; });
    section("Seidel sums", "Seidel");
    if (largest_angle_deg() >= 90 || !has_field) {
      page_.add(html::paragraph("Third-order theory needs a largest field between 0° and 90°."));
      return;
    }
    if (is_ray_transfer(lens_)) {
      page_.add(html::paragraph("A ray transfer has no surfaces that third-order theory could sum over."));
      return;
    }
    const Lens designed = as_designed(lens_);
    if (!is_round(designed) || std::ranges::any_of(lens_.surfaces, [](const Surface& surface) {
          return surface.grating || surface.ideal_lens;
        })) {
      page_.add(html::paragraph(
          "Third-order theory is that of round surfaces about one axis; the Zernike coefficients "
          "below are those of this lens."));
      return;
    }
    if (has_poses(lens_)) page_.add(html::paragraph("Of the lens as designed, without its poses:"));
    const SeidelSums sums = seidel_sums(designed);
    page_.add(figure_with_data(
        seidel_plot(sums).svg(),
        fmt::format("Wavefront coefficients at {:g} nm, colour between {:g} and {:g} nm.", sums.wavelength_nm,
                    lens_.wavelengths_nm.front(), lens_.wavelengths_nm.back()),
        "seidel.csv", tabulate(sums)));
    page_.add(html::table(tabulate(sums)));
  }
  double largest_angle_deg() const {
    double largest = 0;
    if (!lens_.object_distance_mm)
      for (const double field : lens_.fields.values)
        largest = std::max(largest, std::abs(object_field(lens_, lens_.fields.kind, field)));
    return largest;
  }
  void zernikes() {
    section("Zernike coefficients", "Zernike");
    const auto rows = zernike_table(with_round_stop(lens_), at_reference(request_, lens_),
                                    ZernikeOrder::fringe, largest_fringe_index);
    Table table{{{"term", "", 0}, {"name"}}, {}};
    for (const WavefrontZernikeRow& row : rows)
      table.columns.push_back({field_text(kind_, row.field), "waves", 4});
    for (int j = 1; j <= zernike_terms; ++j) {
      table.rows.push_back({static_cast<double>(j), zernike_name(zernike_term(ZernikeOrder::fringe, j))});
      for (const WavefrontZernikeRow& row : rows)
        table.rows.back().emplace_back(row.coefficients[static_cast<std::size_t>(j - 1)]);
    }
    table.rows.push_back({NAN, std::string("left by 37 terms, RMS")});
    for (const WavefrontZernikeRow& row : rows) table.rows.back().emplace_back(row.rms_residual_waves);
    page_.add(figure_with_data(zernike_plot(kind_, rows, ZernikeOrder::fringe).svg(),
                               "Fringe terms of the wavefront over the stop at the reference wavelength.",
                               "zernike.csv", tabulate(kind_, rows, ZernikeOrder::fringe)));
    page_.add(html::table(table));
  }

  html::Page& page_;
  const Lens& lens_;
  const ReportLens& report_;
  const FieldTableRequest& request_;
  Fields::Kind kind_;
  const LensReportOptions& options_;
  std::string end_;
};

void add_comparison(html::Page& page, const std::vector<ReportLens>& lenses,
                    const LensReportOptions& options) {
  const double frequency = options.frequencies_cpmm[options.frequencies_cpmm.size() / 2];
  Table table{{{"lens"},
               {"focal length", "mm", 3},
               {"f-number", "", 2},
               {"field of view", "deg", 1},
               {"total track", "mm", 2},
               {"surfaces", "", 0},
               {"worst RMS spot", "µm", 2},
               {"worst RMS wavefront", "waves", 3},
               {fmt::format("least MTF at {:g} c/mm", frequency), "", 3},
               {"largest distortion", "%", 2},
               {"least illumination", "", 3},
               {"largest chief-ray angle", "deg", 1}},
              {}};
  for (const ReportLens& each : lenses) {
    const FirstOrder data = first_order(each.lens);
    const FieldTableRequest reference = at_reference(each.request, each.lens);
    double spot = 0, wavefront = 0, mtf = 1, distortion = 0, illumination = 1, angle = 0;
    for (const SpotRow& row : spot_table(each.lens, each.request)) spot = std::max(spot, row.rms_radius_um);
    for (const WavefrontRow& row : wavefront_table(with_round_stop(each.lens), each.request))
      wavefront = std::max(wavefront, row.rms_without_tilt_waves);
    MtfOptions one;
    one.frequencies_cpmm = {frequency};
    one.weights.assign(each.request.wavelengths_nm.size(), 1);
    for (const MtfRow& row : mtf_table(each.lens, each.request, one))
      mtf = std::min({mtf, row.tangential, row.sagittal});
    for (const DistortionRow& row : distortion_table(each.lens, reference))
      if (std::abs(row.distortion_percent) > std::abs(distortion)) distortion = row.distortion_percent;
    for (const IlluminationRow& row : illumination_table(each.lens, reference))
      illumination = std::min(illumination, row.relative_illumination);
    for (const ChiefRayAngleRow& row : chief_ray_angle_table(each.lens, reference))
      if (std::abs(row.chief_ray_angle_deg) > std::abs(angle)) angle = row.chief_ray_angle_deg;
    table.rows.push_back({each.lens.name, data.efl_mm, data.f_number, data.field_of_view_deg,
                          data.total_track_mm, static_cast<double>(each.lens.surfaces.size()), spot,
                          wavefront, mtf, distortion, illumination, angle});
  }
  page.section("Comparison", "comparison");
  page.add(
      html::paragraph("The worst over each lens's fields and wavelengths; MTF of all wavelengths together; "
                      "distortion, illumination and angle at the reference wavelength. RMS wavefront "
                      "without piston and tilt."));
  page.add(html::table(table));
  page.add(html::download("comparison.csv", "text/csv", to_csv(table), "table (CSV)"));
}

}  // namespace

html::Block figure_with_data(const std::string& svg, const std::string& caption, const std::string& file_name,
                             const Table& data) {
  return {html::figure(html::drawing(svg), caption).markup +
          html::download(file_name, "text/csv", to_csv(data), "data (CSV)").markup};
}

std::string lens_report_html(const std::vector<ReportLens>& lenses, const LensReportOptions& options) {
  if (lenses.empty()) throw InputError("a report needs a lens");
  if (options.frequencies_cpmm.empty()) throw InputError("a report needs a spatial frequency");
  const bool alone = lenses.size() == 1;
  html::Page page(alone ? lenses[0].lens.name : fmt::format("{} lenses compared", lenses.size()),
                  alone ? "Lens report" : "Lens reports");
  if (!alone) add_comparison(page, lenses, options);
  for (const ReportChapter& chapter : options.chapters)
    page.section(chapter.title).add(html::paragraph(chapter.text)).add(html::table(chapter.table));
  for (const ReportLens& each : lenses) LensSections(page, each, options, alone).add_all();
  page.footer(options.footer);
  return page.html();
}

}  // namespace petzval
