// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/best_focus.h>
#include <petzval/analysis/field_rows.h>
#include <petzval/analysis/field_values.h>
#include <petzval/analysis/ghosts.h>
#include <petzval/analysis/surface_order.h>
#include <petzval/base/error.h>
#include <petzval/flare/ghost_table.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/pose.h>
#include <petzval/lens/ray_transfer.h>
#include <petzval/report/analysis_plots.h>
#include <petzval/report/colours.h>
#include <petzval/report/pupil_plots.h>
#include <petzval/simulate/analysis.h>
#include <petzval/simulate/analysis_result.h>
#include <petzval/simulate/flare.h>
#include <petzval/simulate/glare_analysis.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval {

AnalysisResult result_of(const Lens& lens, const FieldTableRequest& at, std::string heading, Table table) {
  AnalysisResult result;
  result.lens = result.plots_title = lens.name;
  result.field_kind = at.field_kind;
  result.reference_wavelength_nm = lens.reference_wavelength_nm;
  result.tables.push_back({"rows", std::move(heading), std::move(table)});
  return result;
}

namespace {

constexpr double gap = std::numeric_limits<double>::quiet_NaN();

/// Fields or zones of a smooth curve, and rays of a smooth fan.
constexpr int smooth_fields = 41, smooth_rays = 81;
/// Fields of an MTF over the field.
constexpr int mtf_fields = 21;
/// Rings of rays in a spot diagram: 3·8·9 = 216 points.
constexpr int diagram_rings = 8;
constexpr int fringe_terms = 37, noll_terms = 36;

FieldTableRequest dense(FieldTableRequest request) {
  request.fields = even_fields(request.fields, smooth_fields);
  return request;
}

/// The same table with a last column for programs: the fields as angles or heights of the object.
template <class Row>
Table with_object_fields(Table table, const Lens& lens, const std::vector<Row>& rows) {
  table.columns.push_back({"", "", 0, lens.object_distance_mm ? "object_height_mm" : "object_angle_deg"});
  for (std::size_t i = 0; i < rows.size(); ++i) table.rows[i].emplace_back(rows[i].object_field);
  return table;
}

/// Rows in the order fields × wavelengths as one curve a wavelength.
template <class Row>
Plot curves(const std::string& title, const PlotAxis& y_axis, const std::vector<Row>& rows,
            std::size_t wavelengths, double Row::*x, double Row::*y) {
  Plot plot;
  plot.title = title;
  plot.x = {"real image height", "mm", PlotScale::linear, {}, {}};
  plot.y = y_axis;
  for (std::size_t w = 0; w < wavelengths; ++w) {
    std::vector<double> xs, ys;
    for (std::size_t i = w; i < rows.size(); i += wavelengths) {
      if (!std::isfinite(rows[i].*x) || !std::isfinite(rows[i].*y)) continue;
      xs.push_back(rows[i].*x);
      ys.push_back(rows[i].*y);
    }
    PlotSeries& line = plot.line(fmt::format("{:g} nm", rows[w].wavelength_nm), xs, ys);
    line.colour = wavelength_colour(rows[w].wavelength_nm).hex();
    constexpr std::size_t few = 12;
    if (xs.size() <= few) line.marker = PlotMarker::dot;
  }
  return plot;
}

void add_tv_distortion(const Lens& lens, const AnalysisRequest& request, AnalysisResult& result) {
  const std::optional<FrameSize> frame = request.frame ? request.frame : frame_of_fields(lens);
  if (!frame) return;
  try {
    result.tables.push_back({"tv_rows",
                             fmt::format("how much the long edges of a frame of {:.4g} x {:.4g} mm bend",
                                         frame->width_mm, frame->height_mm),
                             tabulate(tv_distortion(lens, *frame, request.at.wavelengths_nm))});
  } catch (const InputError& error) {
    result.remarks.push_back(fmt::format("no TV distortion: {}", error.what()));
  }
}

AnalysisResult distortion(const Lens& lens, const AnalysisRequest& request, const Context&) {
  const std::vector<DistortionRow> rows = distortion_table(lens, request.at);
  AnalysisResult result = result_of(lens, request.at,
                                    "distortion about the centre, against the paraxial "
                                    "image height and against f-theta",
                                    with_object_fields(tabulate(request.at.field_kind, rows), lens, rows));
  if (request.plots)
    result.plots = {curves("Distortion", {"distortion", "%", PlotScale::linear, {}, {}},
                           distortion_table(lens, dense(request.at)), request.at.wavelengths_nm.size(),
                           &DistortionRow::image_height_mm, &DistortionRow::distortion_percent)};
  add_tv_distortion(lens, request, result);
  const std::optional<FrameSize> frame = request.frame ? request.frame : frame_of_fields(lens);
  if (request.plots && frame) {
    result.plots.push_back(distortion_grid_plot(distortion_grid(lens, *frame, lens.reference_wavelength_nm)));
    result.plots_across = 2;
  }
  return result;
}

AnalysisResult illumination(const Lens& lens, const AnalysisRequest& request, const Context& context) {
  const std::vector<IlluminationRow> rows = illumination_table(lens, request.at);
  for (const IlluminationRow& row : rows)
    if (!row.pupil_in_one_piece)
      send_note(context, fmt::format("at field {:g} and {:g} nm the pupil has a hole or falls into parts; "
                                     "g_sensor counts what lies around the chief ray, holes filled",
                                     row.field, row.wavelength_nm));
  AnalysisResult result = result_of(
      lens, request.at, "irradiance per radiance at the sensor (g_sensor) and per source point (g_source)",
      with_object_fields(tabulate(request.at.field_kind, rows), lens, rows));
  if (request.plots)
    result.plots = {curves("Relative illumination",
                           {"g_sensor / g_sensor on axis", "", PlotScale::linear, 0.0, {}}, rows,
                           request.at.wavelengths_nm.size(), &IlluminationRow::real_image_height_mm,
                           &IlluminationRow::relative_illumination)};
  return result;
}

AnalysisResult encircled(const Lens& lens, const AnalysisRequest& request, const Context&) {
  EncircledEnergyOptions options = request.encircled_energy;
  std::sort(options.radii_um.begin(), options.radii_um.end());
  const char* about = options.about_centroid ? "centroid" : "chief ray";
  const std::vector<EncircledEnergyRow> rows = encircled_energy_table(lens, request.at, options);
  AnalysisResult result =
      result_of(lens, request.at, fmt::format("shares of the light within circles about the {}", about),
                tabulate(request.at.field_kind, rows));
  result.facts = {{"about", about}};
  if (request.plots) result.plots = {encircled_energy_plot(request.at.field_kind, rows)};
  return result;
}

AnalysisResult spots(const Lens& lens, const AnalysisRequest& request, const Context&) {
  const std::vector<SpotRow> rows = spot_table(lens, request.at, request.spot_weight);
  AnalysisResult result =
      result_of(lens, request.at,
                fmt::format("spot radii about the centroid, rays weighted by {}",
                            request.spot_weight == RayWeight::light ? "their light" : "area on the stop"),
                tabulate(request.at.field_kind, rows));
  if (request.plots) {
    result.plots = spot_plots(request.at.field_kind, spot_diagrams(lens, request.at, diagram_rings), rows);
    result.plots_across = spot_plots_across;
  }
  return result;
}

AnalysisResult wavefronts(const Lens& lens, const AnalysisRequest& request, const Context&) {
  const std::vector<WavefrontRow> rows = wavefront_table(lens, request.at);
  AnalysisResult result =
      result_of(lens, request.at, "wavefront aberration about the chief ray's image point, piston removed",
                tabulate(request.at.field_kind, rows));
  if (request.plots) result.plots = {wavefront_plot(request.at.field_kind, rows)};
  return result;
}

AnalysisResult wavefront_map(const Lens& lens, const AnalysisRequest& request, const Context&) {
  const std::vector<WavefrontMap> maps = wavefront_maps(lens, request.at, request.map_samples);
  AnalysisResult result =
      result_of(lens, request.at, "wavefront over the stop", tabulate(request.at.field_kind, maps));
  result.plots_title = lens.name + ": wavefront over the stop";
  result.plots_across = static_cast<int>(std::max<std::size_t>(request.at.wavelengths_nm.size(), 3));
  if (request.plots) result.plots = wavefront_map_plots(request.at.field_kind, maps);
  return result;
}

AnalysisResult fans(const Lens& lens, const AnalysisRequest& request, const Context&) {
  AnalysisResult result = result_of(
      lens, request.at,
      fmt::format("rays across the stop, from the chief ray of {:g} nm", lens.reference_wavelength_nm),
      tabulate(request.at.field_kind, aberration_fans(lens, request.at, request.fan_rays)));
  result.plots_title = fmt::format("{}: {}", lens.name, request.opd_fans ? "OPD fans" : "ray fans");
  result.plots_across = 2;
  if (request.plots)
    result.plots = fan_plots(request.at.field_kind,
                             aberration_fans(lens, request.at, std::max(smooth_rays, request.fan_rays)),
                             request.opd_fans ? FanQuantity::opd : FanQuantity::transverse);
  return result;
}

AnalysisResult zernike(const Lens& lens, const AnalysisRequest& request, const Context&) {
  const bool noll = request.zernike_order == ZernikeOrder::noll;
  const char* order = noll ? "noll" : "fringe";
  const int terms = request.zernike_terms > 0 ? request.zernike_terms : noll ? noll_terms : fringe_terms;
  const std::vector<WavefrontZernikeRow> rows = zernike_table(lens, request.at, request.zernike_order, terms);
  AnalysisResult result =
      result_of(lens, request.at, fmt::format("wavefront over the stop in {} {} Zernike terms", terms, order),
                tabulate(request.at.field_kind, rows, request.zernike_order));
  result.facts = {{"order", order},
                  {"normalisation", noll ? "mean square 1 over the disc" : "1 in size at the rim"}};
  AnalysisTable residuals{"residuals",
                          "",
                          {{{"", "", 0, "field"},
                            {"", "", 0, "wavelength_nm"},
                            {"", "", 0, "real_image_height_mm"},
                            {"", "", 0, "rms_residual_waves"}},
                           {}}};
  for (const WavefrontZernikeRow& row : rows) {
    residuals.table.rows.push_back(
        {row.field, row.wavelength_nm, row.real_image_height_mm, row.rms_residual_waves});
    result.remarks.push_back(fmt::format("left at {:g} {} and {:g} nm: {:.3g} waves RMS", row.field,
                                         field_unit(request.at.field_kind), row.wavelength_nm,
                                         row.rms_residual_waves));
  }
  result.tables.push_back(std::move(residuals));
  if (request.plots) result.plots = {zernike_plot(request.at.field_kind, rows, request.zernike_order)};
  return result;
}

AnalysisResult field_curvature(const Lens& lens, const AnalysisRequest& request, const Context&) {
  AnalysisResult result =
      result_of(lens, request.at, "foci beside the real chief ray, from the image surface along z",
                tabulate(request.at.field_kind, field_curvature_table(lens, request.at)));
  if (!request.plots) return result;
  const FieldTableRequest fields = dense(request.at);
  FieldTableRequest reference = fields;
  reference.wavelengths_nm = {lens.reference_wavelength_nm};
  result.plots = {field_curvature_plot(request.at.field_kind, field_curvature_table(lens, fields),
                                       field_curvature_table(lens, reference))};
  return result;
}

AnalysisResult colour(const Lens& lens, const AnalysisRequest& request, const Context&) {
  AnalysisResult result =
      result_of(lens, request.at,
                fmt::format("Height of the chief ray, less that of {:g} nm", lens.reference_wavelength_nm),
                tabulate(request.at.field_kind, lateral_colour_table(lens, request.at)));
  const auto axial = [&](const std::vector<double>& zones) {
    return axial_focus_table(lens, request.at.wavelengths_nm, zones, request.at.clip);
  };
  result.tables.insert(
      result.tables.begin(),
      {"axial_rows", "where rays of the axial point cross the axis, from the image surface; zone 0: paraxial",
       tabulate(axial({0, 0.7, 1}))});
  result.plots_title = lens.name + ": colour";
  result.plots_across = 2;
  if (request.plots)
    result.plots = {
        longitudinal_plot(axial(even_fields({1.0}, smooth_fields))),
        lateral_colour_plot(request.at.field_kind, lateral_colour_table(lens, dense(request.at)))};
  return result;
}

AnalysisResult vignetting(const Lens& lens, const AnalysisRequest& request, const Context&) {
  AnalysisResult result =
      result_of(lens, request.at, "what each field's light fills of the stop, in stop radii",
                tabulate(request.at.field_kind, vignetting_table(lens, request.at)));
  if (request.plots)
    result.plots = {vignetting_plot(request.at.field_kind, vignetting_table(lens, dense(request.at)))};
  if (request.plots && !is_ray_transfer(lens)) {
    const FieldTableRequest at = with_own_lists(request.at, lens);
    std::ranges::move(footprint_plots(at.field_kind, lens, footprints(lens, at)),
                      std::back_inserter(result.plots));
    result.plots.front().width_px = footprint_plot_px;
    result.plots_across = footprint_plots_across;
  }
  return result;
}

AnalysisResult polarisation(const Lens& lens, const AnalysisRequest& request, const Context&) {
  const std::vector<PolarisationRow> rows = polarisation_table(lens, request.at);
  AnalysisResult result = result_of(
      lens, request.at, "what surfaces do to polarisation; Strehl ratio of unpolarised light by that alone",
      tabulate(request.at.field_kind, rows));
  if (!request.plots) return result;
  const std::vector<PolarisationRow> smooth = polarisation_table(lens, dense(request.at));
  const std::size_t wavelengths = request.at.wavelengths_nm.size();
  result.plots = {
      curves("Diattenuation, largest of the pupil", {"diattenuation", "", PlotScale::linear, 0.0, {}}, smooth,
             wavelengths, &PolarisationRow::real_image_height_mm, &PolarisationRow::largest_diattenuation),
      curves("Retardance, largest of the pupil", {"retardance", "nm", PlotScale::linear, 0.0, {}}, smooth,
             wavelengths, &PolarisationRow::real_image_height_mm, &PolarisationRow::largest_retardance_nm)};
  result.plots_across = 2;
  return result;
}

AnalysisResult chief_ray_angle(const Lens& lens, const AnalysisRequest& request, const Context&) {
  AnalysisResult result = result_of(lens, request.at, "angle at the sensor, positive away from the axis",
                                    tabulate(request.at.field_kind, chief_ray_angle_table(lens, request.at)));
  if (request.plots) result.plots = {chief_ray_angle_plot(chief_ray_angle_table(lens, dense(request.at)))};
  return result;
}

AnalysisResult mtf(const Lens& lens, const AnalysisRequest& request, const Context&) {
  FieldTableRequest at = request.at;
  MtfOptions options = request.mtf;
  const bool through_focus = request.mtf_through_focus_mm.has_value();
  if (options.frequencies_cpmm.empty() && (request.mtf_over_field || through_focus))
    options.frequencies_cpmm = {10, 20, 40};
  else if (options.frequencies_cpmm.empty())
    options.frequencies_cpmm = {0, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100};
  if (request.mtf_over_field) at.fields = even_fields(at.fields, mtf_fields);
  if (through_focus) options.sensor_shifts_mm = even_shifts(*request.mtf_through_focus_mm);
  if (request.polychromatic_mtf && options.weights.empty())
    options.weights.assign(at.wavelengths_nm.size(), 1);
  const std::vector<MtfRow> rows = mtf_table(lens, at, options);

  const char* method = options.geometric ? "geometric" : "diffraction";
  AnalysisResult result =
      result_of(lens, at, through_focus ? "" : fmt::format("{} MTF", method), tabulate(at.field_kind, rows));
  result.facts = {{"method", method}};
  if (!options.weights.empty()) {
    result.facts.emplace_back("wavelengths_nm", at.wavelengths_nm);
    result.facts.emplace_back("weights", options.weights);
  }
  if (request.plots) {
    const std::size_t frequencies = options.frequencies_cpmm.size();
    result.plots = {through_focus            ? mtf_focus_plot(at.field_kind, rows)
                    : request.mtf_over_field ? mtf_field_plot(at.field_kind, rows, frequencies)
                                             : mtf_plot(at.field_kind, rows, frequencies)};
  }
  return result;
}

AnalysisResult best_focus(const Lens& lens, const AnalysisRequest& request, const Context&) {
  const double frequency = request.focus_frequency_cpmm;
  const BestFocus spot = best_spot_focus(lens, request.at), mtf = best_mtf_focus(lens, request.at, frequency);
  const FirstOrder first = first_order(lens);
  const double design_mm = lens.image_distance_mm();
  const double paraxial_mm = first.paraxial_image_mm - design_mm;
  Table table{{{"focus", "", 0, "focus"},
               {"sensor shift", "mm", 5, "sensor_shift_mm"},
               {"image distance", "mm", 5, "image_distance_mm"},
               {"measure", "", 0, "measure"},
               {"before", "", 4, "before"},
               {"after", "", 4, "after"}},
              {}};
  table.rows.push_back(
      {std::string("paraxial"), paraxial_mm, design_mm + paraxial_mm, std::string(), gap, gap});
  table.rows.push_back({std::string("best-spot"), spot.shift_mm, design_mm + spot.shift_mm,
                        std::string("RMS spot radius [um]"), spot.before, spot.after});
  table.rows.push_back({fmt::format("best-mtf@{:g}", frequency), mtf.shift_mm, design_mm + mtf.shift_mm,
                        fmt::format("mean MTF at {:g} cycles/mm", frequency), mtf.before, mtf.after});
  AnalysisResult result =
      result_of(lens, request.at, "places of the sensor, counted from where it is", std::move(table));
  result.remarks.push_back(fmt::format(
      "`focus` paraxial, best-spot or best-mtf@{:g} puts the sensor there, or `image_distance_mm` {:.5f}",
      frequency, design_mm + mtf.shift_mm));
  if (request.plots) {
    MtfOptions through;
    through.frequencies_cpmm = {frequency};
    through.weights.assign(request.at.wavelengths_nm.size(), 1);
    through.sensor_shifts_mm = even_shifts(2 * std::max({std::abs(spot.shift_mm), std::abs(mtf.shift_mm),
                                                         1 / frequency / (2 * first.image_space_na)}));
    result.plots = {mtf_focus_plot(request.at.field_kind, mtf_table(lens, request.at, through))};
  }
  return result;
}

AnalysisResult ghost_reflections(const Lens& lens, const AnalysisRequest& request, const Context&) {
  GhostOptions options;
  // All of a lens's own wavelengths would say the same several times over.
  if (request.at.wavelengths_nm != lens.wavelengths_nm) options.wavelengths_nm = request.at.wavelengths_nm;
  options.losses = request.at.losses;
  options.sensor_reflectance = request.sensor_reflectance;
  options.source_diameter_deg = request.source_diameter_deg;
  options.reflections = request.ghost_reflections;
  const std::size_t sensor = lens.surfaces.size();
  const bool centred = is_round(lens) && !lens.has_mirrors();
  std::vector<Ghost> rows;
  Table table;
  if (centred) {
    rows = ghosts(lens, options);
    table = tabulate(rows, sensor);
  } else {
    const std::vector<PosedGhost> found = ghosts_about_chief_ray(lens, options);
    for (const PosedGhost& each : found) rows.push_back(each.ghost);
    table = tabulate(rows, sensor);
    table.columns.push_back({"x", "mm", 4, "x_mm"});
    table.columns.push_back({"y", "mm", 4, "y_mm"});
    for (std::size_t i = 0; i < found.size(); ++i)
      table.rows[i].insert(table.rows[i].end(), {found[i].x_mm, found[i].y_mm});
  }
  AnalysisResult result =
      result_of(lens, request.at,
                fmt::format("{} reflections, {}, of a source {:g} deg wide; focus from the image surface{}",
                            options.reflections == 4 ? "two and four" : "double",
                            centred ? "paraxial" : "about the chief ray of the middle of the field",
                            options.source_diameter_deg, centred ? "" : "; x and y from the image"),
                std::move(table));
  result.facts = {{"source_diameter_deg", std::vector<double>{options.source_diameter_deg}}};
  if (request.plots) result.plots = {ghost_plot(rows, sensor)};
  return result;
}

const Analysis table_of_analyses[] = {
    {"distortion", "Real and paraxial image heights by field and wavelength", distortion},
    {"illumination", "Absolute and relative illumination by field and wavelength", illumination},
    {"encircled-energy", "Share of a point's light within circles, by field and wavelength", encircled},
    {"spots", "Spot sizes by field and wavelength, and spot diagrams", spots},
    {"wavefront", "Wavefront aberration and Strehl ratio by field and wavelength", wavefronts},
    {"wavefront-map", "Wavefront aberration over the stop", wavefront_map},
    {"fans", "Ray fans and OPD fans, tangential and sagittal", fans},
    {"zernike", "The wavefront as Zernike polynomials, Noll or Fringe", zernike},
    {"field-curvature", "Tangential and sagittal foci beside the real chief ray, and the Petzval curve",
     field_curvature},
    {"colour", "Axial and lateral colour of real rays", colour},
    {"vignetting", "How much of the stop each field fills, and which surfaces take the rest", vignetting},
    {"chief-ray-angle", "At what angle the light meets the sensor", chief_ray_angle},
    {"polarisation", "Diattenuation and retardance by the surfaces, and what they take from a point's image",
     polarisation},
    {"ghosts", "Light that two surfaces reflect: where it is focused, how wide and how bright",
     ghost_reflections},
    {"glare", "Veiling glare by scatter and ghosts, and the glare spread function, by field", glare_analysis},
    {"mtf", "Modulation transfer, tangential and sagittal, by frequency, field and wavelength", mtf},
    {"focus", "Best focus by spot size and by MTF, all fields and wavelengths together", best_focus}};

}  // namespace

const Table& AnalysisResult::rows() const {
  const auto found = std::find_if(tables.begin(), tables.end(),
                                  [](const AnalysisTable& each) { return each.key == "rows"; });
  return found->table;
}

std::span<const Analysis> analyses() {
  return table_of_analyses;
}

AnalysisResult analyse(std::string_view name, const Lens& lens, const AnalysisRequest& request,
                       const Context& context) {
  std::string names;
  for (const Analysis& each : analyses()) {
    if (each.name != name) {
      names += fmt::format("{}{}", names.empty() ? "" : ", ", each.name);
      continue;
    }
    lens.validate();
    require_surfaces_in_order(lens);
    AnalysisRequest asked = request;
    asked.at = with_own_lists(std::move(asked.at), lens);
    AnalysisResult result =
        result_within(context, [&](const ProgressCallback&) { return each.run(lens, asked, context); });
    if (asked.at.azimuth_deg != 0) {
      result.facts.push_back({"azimuth_deg", std::vector<double>{asked.at.azimuth_deg}});
      result.remarks.push_back(
          fmt::format("fields at an azimuth of {:g} deg, anticlockwise from +y as seen from the film",
                      asked.at.azimuth_deg));
    }
    return result;
  }
  throw InputError(fmt::format("there is no analysis \"{}\"; there are {}", name, names));
}

}  // namespace petzval
