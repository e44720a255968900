// SPDX-License-Identifier: BSD-3-Clause
// Targets of exactly known sharpness.
#include <petzval/target/formats/polygon_file.h>
#include <petzval/target/test_charts.h>

#include <numbers>

#include "call.h"
#include "camera.h"

namespace petzval::python {

namespace {

/// A closed line of (x, y), and the level of what it encloses.
using PolygonIn = std::pair<std::vector<std::pair<double, double>>, double>;

TargetScene scene_of(const Maybe<std::array<double, 3>>& rectangle_px, Maybe<double> half_plane_deg,
                     const Maybe<std::string>& chart, const std::vector<PolygonIn>& polygons,
                     const Maybe<std::string>& file, Maybe<std::pair<double, double>> at,
                     std::pair<int, int> size) {
  const int given = rectangle_px.has_value() + half_plane_deg.has_value() + chart.has_value() +
                    !polygons.empty() + file.has_value();
  if (given != 1)
    throw InputError("a target is one of `rectangle`, `half_plane_deg`, `chart`, `polygons` and `file`");
  if (chart) return test_chart(*chart, size.first, size.second);
  if (file) return read_polygon_file(*file);
  TargetScene scene;
  const Vertex centre{at ? at->first : 0.5 * size.first, at ? at->second : 0.5 * size.second};
  if (rectangle_px)
    scene.polygons.push_back(
        {{rectangle(centre, (*rectangle_px)[0], (*rectangle_px)[1], (*rectangle_px)[2])}, 0, 0});
  if (half_plane_deg) scene.polygons.push_back({{half_plane(centre, *half_plane_deg)}, 0, 0});
  for (const auto& [corners, level] : polygons) {
    Contour contour;
    for (const auto& [x, y] : corners) contour.push_back({x, y});
    scene.polygons.push_back({{contour}, level, 0});
  }
  return scene;
}

TargetBlur blur_of(double f_number, const std::map<std::string, double>& w_waves,
                   const std::map<int, double>& zernike_waves, const std::string& zernike_order,
                   double obstruction, int blades, double blade_rotation_deg, double blade_curvature,
                   Maybe<double> sigma_um, const nb::object& lens, double field) {
  const bool pupil_given = !w_waves.empty() || !zernike_waves.empty() || obstruction != 0 || blades != 0;
  if (sigma_um.has_value() + !lens.is_none() + pupil_given > 1)
    throw InputError(
        "`sigma_um`, `lens` and aberrations of a pupil exclude each other; one of them would be right");
  if (sigma_um) return GaussianBlur{*sigma_um};
  if (!lens.is_none())
    return LensBlur{nb::isinstance<nb::str>(lens) ? *lens_from(lens) : lens_to_look_at(lens), field};
  PupilBlur blur{{}, f_number};
  blur.pupil.shape = {blades, blade_rotation_deg * std::numbers::pi / 180, blade_curvature, obstruction};
  const auto w = [&](const char* name) { return w_waves.contains(name) ? w_waves.at(name) : 0.0; };
  for (const auto& [name, value] : w_waves)
    choice<int>("w_waves", name, {{"w020", 0}, {"w040", 0}, {"w060", 0}, {"w080", 0}});
  blur.pupil.w_waves = {w("w020"), w("w040"), w("w060"), w("w080")};
  blur.pupil.order = choice<ZernikeOrder>("zernike_order", zernike_order,
                                          {{"fringe", ZernikeOrder::fringe}, {"noll", ZernikeOrder::noll}});
  for (const auto& [term, value] : zernike_waves) {
    zernike_term(blur.pupil.order, term);
    auto& coefficients = blur.pupil.zernike_waves;
    if (coefficients.size() < static_cast<std::size_t>(term))
      coefficients.resize(static_cast<std::size_t>(term));
    coefficients[static_cast<std::size_t>(term - 1)] = value;
  }
  blur.pupil.validate();
  return blur;
}

SpectralImage target_light(const Maybe<std::array<double, 3>>& rectangle_px, Maybe<double> half_plane_deg,
                           const Maybe<std::string>& chart, const std::vector<PolygonIn>& polygons,
                           const Maybe<std::string>& file, Maybe<std::pair<double, double>> at,
                           std::pair<int, int> size, double f_number,
                           const std::map<std::string, double>& w_waves,
                           const std::map<int, double>& zernike_waves, const std::string& zernike_order,
                           double obstruction, int blades, double blade_rotation_deg, double blade_curvature,
                           Maybe<double> sigma_um, const nb::object& lens, double field,
                           const Numbers& wavelengths_nm, const Numbers& weights, double pitch_um,
                           double fill_factor, const nb::object& sensor, double black, double white,
                           int threads, const nb::object& progress) {
  TargetRequest request;
  request.scene = scene_of(rectangle_px, half_plane_deg, chart, polygons, file, at, size);
  request.columns = size.first, request.rows = size.second;
  request.blur = blur_of(f_number, w_waves, zernike_waves, zernike_order, obstruction, blades,
                         blade_rotation_deg, blade_curvature, sigma_um, lens, field);
  request.wavelengths_nm = wavelengths_nm, request.weights = weights;
  request.pitch_um = pitch_um, request.photosite = Photosite::square(fill_factor);
  if (const auto chosen = sensor_from(sensor)) request.sensor = *chosen;
  request.black = black, request.white = white;
  Call call({threads, 1, progress});
  return call([&](const Context& context) { return target(request, context); });
}

}  // namespace

void bind_target(nb::module_& module) {
  module.def("target_chart_names", &test_chart_names, "Names of the charts that `target` knows.");
  module.def("target", target_light, nb::kw_only(), nb::arg("rectangle").none() = nb::none(),
             nb::arg("half_plane_deg").none() = nb::none(), nb::arg("chart").none() = nb::none(),
             nb::arg("polygons") = std::vector<PolygonIn>(), nb::arg("file").none() = nb::none(),
             nb::arg("at").none() = nb::none(), nb::arg("size") = std::pair(240, 240),
             nb::arg("f_number") = 8.0, nb::arg("w_waves") = std::map<std::string, double>(),
             nb::arg("zernike_waves") = std::map<int, double>(), nb::arg("zernike_order") = "fringe",
             nb::arg("obstruction") = 0.0, nb::arg("blades") = 0, nb::arg("blade_rotation_deg") = 0.0,
             nb::arg("blade_curvature") = 0.0, nb::arg("sigma_um").none() = nb::none(),
             nb::arg("lens").none() = nb::none(), nb::arg("field") = 0.0,
             nb::arg("wavelengths_nm") = Numbers{550}, nb::arg("weights") = Numbers(),
             nb::arg("pitch_um") = 4.73, nb::arg("fill_factor") = 1.0, nb::arg("sensor").none() = nb::none(),
             nb::arg("black") = 0.0, nb::arg("white") = 1.0, nb::arg("threads") = 0,
             nb::arg("progress").none() = nb::none(),
             "Light of figures of exactly known sharpness, a band for each wavelength; level 1 is 1 W/(m2 "
             "nm) over all bands. One figure: `rectangle` "
             "(width, height, angle [degrees]) or `half_plane_deg` about `at` (the middle), a `chart` by "
             "name, `polygons` [(corners, level)] or the "
             "`file` of some; in pixels, x right, y down. One blur: a pupil at `f_number` with `w_waves` "
             "{\"w020\": …} and `zernike_waves` {term: …}, a "
             "Gaussian of `sigma_um`, or a `lens` (or camera) at a `field`. `size`: (columns, rows).");
}

}  // namespace petzval::python
