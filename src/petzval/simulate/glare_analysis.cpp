// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/analysis/field_values.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/flare/veiling_glare.h>
#include <petzval/lens/pose.h>
#include <petzval/simulate/analysis_result.h>
#include <petzval/simulate/flare.h>
#include <petzval/simulate/glare_analysis.h>

#include <cmath>
#include <limits>

namespace petzval {

namespace {

constexpr double not_asked = std::numeric_limits<double>::quiet_NaN();

/// From the middle of an image outwards, across the field.
std::vector<double> distances_from_image(double farthest_mm, int count) {
  constexpr double nearest = 1e-3;  // of the farthest
  std::vector<double> distances;
  for (int i = 0; i < count; ++i)
    distances.push_back(farthest_mm * std::pow(nearest, 1 - static_cast<double>(i) / (count - 1)));
  return distances;
}

Plot glare_spread_plot(const std::string& unit) {
  Plot plot;
  plot.title = "Glare spread function";
  plot.x = {"distance from the image", "mm", PlotScale::logarithmic, {}, {}};
  plot.y = {"irradiance over light", unit, PlotScale::logarithmic, {}, {}};
  return plot;
}

/// On the sensor: so far along the field, and beside it.
std::array<double, 2> place_of(const Lens& lens, double azimuth_deg, double beside_mm, double along_mm) {
  if (is_round(lens)) return {beside_mm, along_mm};
  const double cosine = std::cos(radians(azimuth_deg)), sine = std::sin(radians(azimuth_deg));
  return {beside_mm * cosine - along_mm * sine, beside_mm * sine + along_mm * cosine};
}

/// What scatter makes of points and of a hole at one field and wavelength, by row.
struct GlareField {
  IlluminationRow at;
  VeilingGlare veil;
  ScatterSpread spread;
};

GlareField glare_of(const Lens& lens, const IlluminationRow& row, const GlareOptions& options,
                    const std::vector<double>& distances_mm, const FieldTableRequest& at) {
  const ScatterTracer tracer(lens, row.wavelength_nm, at.losses, at.clip);
  if (!row.lit || !std::isfinite(row.real_image_height_mm))
    throw InputError(fmt::format(
        "no light is imaged at field {:g}; a field that the lens sees would be right", row.field));
  const auto place = [&](double beside_mm) {
    return place_of(lens, at.azimuth_deg, row.real_image_x_mm + beside_mm, row.real_image_height_mm);
  };
  const std::array<double, 2> image = place(0);
  GlareField field{row, veiling_glare(lens, tracer, image, row.g_sensor_sr, options), {}};
  std::vector<std::array<double, 2>> places;
  for (const double distance : distances_mm) places.push_back(place(distance));
  field.spread = scatter_spread(tracer, source_imaged_at(lens, tracer, image[0], image[1]), places);
  return field;
}

}  // namespace

AnalysisResult glare_analysis(const Lens& plain, const AnalysisRequest& request, const Context&) {
  const bool is_clean = !request.glare.surfaces_scatter && !states_scatter(plain);
  const Lens lens = is_clean ? plain : scattering_lens(plain, request.glare.surfaces_scatter);
  FieldTableRequest at = request.at;
  if (at.wavelengths_nm == lens.wavelengths_nm) at.wavelengths_nm = {lens.reference_wavelength_nm};
  const std::vector<IlluminationRow> illumination = illumination_table(lens, at);
  double diagonal_mm = request.frame ? std::hypot(request.frame->width_mm, request.frame->height_mm) : 0;
  for (const IlluminationRow& row : illumination)
    if (!request.frame) diagonal_mm = std::max(diagonal_mm, 2 * std::abs(row.real_image_height_mm));
  if (!(diagonal_mm > 0))
    throw InputError("no frame and no field off the axis; `sensor` or a second field would be right");
  if (!(request.glare.hole_percent > 0 && request.glare.hole_percent <= 50))
    throw InputError(fmt::format("a hole of {:g} % of the frame; more than 0 and up to 50 would be right",
                                 request.glare.hole_percent));
  GlareOptions options;
  options.hole_mm = diagonal_mm * request.glare.hole_percent / 100;
  options.surround_deg = request.glare.surround_deg;
  constexpr int few_distances = 7, smooth_distances = 31;
  const std::vector<double> distances =
      distances_from_image(diagonal_mm / 2, request.plots ? smooth_distances : few_distances);

  Table table{{{"field", field_unit(at.field_kind), 2, "field"},
               {"wavelength", "nm", 1, "wavelength_nm"},
               {"image height", "mm", 3, "real_image_height_mm"},
               {"scattered", "%", 3, "scattered_percent"},
               {"veil by scatter", "%", 3, "scatter_percent"},
               {"by ghosts", "%", 3, "ghosts_percent"},
               {"VGI", "%", 3, "veiling_glare_index_percent"}},
              {}};
  Table spread{{{"field", field_unit(at.field_kind), 2, "field"},
                {"wavelength", "nm", 1, "wavelength_nm"},
                {"distance", "mm", 4, "distance_mm"},
                {"glare spread", "1/mm2", 9, "glare_spread_per_mm2", {"", ".3e"}}},
               {}};
  Plot plot = glare_spread_plot("1/mm²");
  for (const double wavelength_nm : at.wavelengths_nm) {
    std::vector<IlluminationRow> rows;
    std::vector<std::array<double, 2>> places;
    for (const IlluminationRow& row : illumination)
      if (row.wavelength_nm == wavelength_nm)
        rows.push_back(row),
            places.push_back(place_of(lens, at.azimuth_deg, row.real_image_x_mm, row.real_image_height_mm));
    std::vector<double> ghosts(rows.size(), 0);
    GhostLightOptions how;
    how.losses = at.losses;
    how.sensor = request.sensor_reflectance;
    how.clip = at.clip;
    if (request.glare.ghosts) ghosts = ghost_veil(lens, wavelength_nm, places, options, how);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      GlareField field = glare_of(lens, rows[i], options, distances, at);
      field.veil.ghosts_sr = ghosts[i];
      const double white = field.veil.white_sr + field.veil.ghosts_sr;
      table.rows.push_back({rows[i].field, wavelength_nm, rows[i].real_image_height_mm,
                            100 * field.veil.scattered_share, 100 * field.veil.scatter_sr / white,
                            request.glare.ghosts ? 100 * field.veil.ghosts_sr / white : not_asked,
                            100 * field.veil.index()});
      std::vector<double> values;
      for (std::size_t k = 0; k < distances.size(); ++k) {
        values.push_back(field.spread.per_light(k));
        constexpr std::size_t thin = (smooth_distances - 1) / (few_distances - 1);
        if (!request.plots || k % thin == 0)
          spread.rows.push_back({rows[i].field, wavelength_nm, distances[k], values.back()});
      }
      plot.line(fmt::format("{:g} {}, {:g} nm", rows[i].field, field_unit(at.field_kind), wavelength_nm),
                distances, values);
    }
  }
  AnalysisResult result = result_of(
      lens, at,
      fmt::format(
          "veiling glare in a black hole {:.3g} mm wide on the sensor, in an even surround up to {:g} "
          "degrees from the axis (ISO 9358)",
          options.hole_mm, options.surround_deg),
      std::move(table));
  result.tables.push_back({"spread_rows",
                           "glare spread function: irradiance over the light of a point's image, across the "
                           "field from it",
                           std::move(spread)});
  result.facts = {{"hole_mm", std::vector<double>{options.hole_mm}},
                  {"surround_deg", std::vector<double>{options.surround_deg}}};
  if (is_clean)
    result.remarks.push_back(
        "no surface says how it scatters, so none does; roughness=1.5 would be right (`scatter`)");
  if (request.plots) result.plots = {std::move(plot)};
  return result;
}

}  // namespace petzval
