// SPDX-License-Identifier: BSD-3-Clause
// What a lens does for a sensor at a distance, and which bundled lenses do what is asked.
#include <petzval/base/quantities.h>
#include <petzval/simulate/lens_on_sensor.h>

#include <algorithm>
#include <cmath>

#include "analysis.h"
#include "call.h"
#include "camera.h"

namespace petzval::python {

namespace {

/// A length with its unit, "infinity", or None for it.
std::optional<double> distance_from(const std::optional<std::string>& distance) {
  if (!distance) return {};
  const double distance_m = parse_distance_m(*distance, "distance");
  return std::isinf(distance_m) ? std::nullopt : std::optional(distance_m);
}

LensOnSensor on_sensor(const CameraInPython& self, const std::optional<std::string>& distance,
                       const Numbers& wavelengths_nm, int threads, const nb::object& progress) {
  const Camera camera = self.value();
  const std::optional<double> distance_m = distance_from(distance);
  Call call({threads, 1, progress});
  return call(
      [&](const Context& context) { return lens_on_sensor(camera, distance_m, wavelengths_nm, context); });
}

std::vector<LensOnSensor> matched(const nb::object& sensor, const std::string& distance, double width_mm,
                                  std::optional<double> f_number, const Numbers& wavelengths_nm, bool scaled,
                                  int threads, const nb::object& progress) {
  LensMatchRequest request;
  const std::shared_ptr<Sensor> chosen = sensor_from(sensor);
  if (!chosen) throw InputError("`sensor` None; a sensor or the name of one would be right");
  request.sensor = *chosen;
  const std::optional<double> distance_m = distance_from(distance);
  if (!distance_m)
    throw InputError("`distance` infinity: a finite distance, at which `width_mm` is seen, would be right");
  request.distance_m = *distance_m;
  request.width_mm = width_mm;
  request.f_number = f_number;
  if (!wavelengths_nm.empty()) request.wavelengths_nm = wavelengths_nm;
  request.scaled = scaled;
  Call call({threads, 1, progress});
  return call([&](const Context& context) { return match_lenses(request, context); });
}

nb::tuple range_of(const DepthOfField& depth) {
  return nb::make_tuple(depth.near_m, depth.far_m);
}

nb::list places_of(const LensOnSensor& lens) {
  nb::list places;
  for (const PlaceOnSensor& place : lens.places) {
    nb::dict one;
    one["real_image_height_mm"] = place.real_image_height_mm;
    one["relative_illumination"] = place.relative_illumination;
    one["half_nyquist"] = nb::make_tuple(place.half_nyquist_tangential, place.half_nyquist_sagittal);
    one["nyquist"] = nb::make_tuple(place.nyquist_tangential, place.nyquist_sagittal);
    places.append(one);
  }
  return places;
}

nb::object beside(const std::vector<LensOnSensor>& lenses) {
  if (lenses.empty()) throw InputError("`lenses` is empty; what on_sensor() gave would be right");
  Table table = lens_on_sensor_table(lenses);
  for (std::size_t c = 0; c < table.columns.size(); ++c) {  // one lens twice
    const auto end = table.columns.begin() + static_cast<std::ptrdiff_t>(c);
    const auto same = std::count_if(table.columns.begin(), end, [&](const TableColumn& column) {
      return column.name == table.columns[c].name;
    });
    if (same > 0) table.columns[c].key = table.columns[c].name + " (" + std::to_string(same + 1) + ")";
  }
  return table_of({"rows", "", table});
}

}  // namespace

void bind_selection(nb::class_<CameraInPython>& camera, nb::module_& module) {
  using L = LensOnSensor;
  nb::class_<L>(module, "LensOnSensor",
                "What a lens does for a sensor at a distance: the numbers by which lenses are chosen.")
      .def_ro("lens", &L::lens)
      .def_ro("scale", &L::scale, "What match_lenses scaled the lens by.")
      .def_ro("efl_mm", &L::efl_mm)
      .def_ro("f_number", &L::f_number)
      .def_ro("working_f_number", &L::working_f_number)
      .def_ro("magnification", &L::magnification, "Paraxial; 0 at infinity.")
      .def_prop_ro(
          "seen", [](const L& self) { return nb::make_tuple(self.view.width, self.view.height); },
          "Width and height of what the sensor sees: mm, or degrees at infinity.")
      .def_ro("per_pixel", &L::per_pixel, "In the middle: mm, or degrees at infinity.")
      .def_ro("image_circle_mm", &L::image_circle_mm)
      .def_ro("sensor_diagonal_mm", &L::sensor_diagonal_mm)
      .def_ro("nyquist_cpmm", &L::nyquist_cpmm)
      .def_prop_ro(
          "sharp_to_a_pixel_m", [](const L& self) { return range_of(self.geometric); },
          "(near, far) from the sensor plane: blur of at most one pixel by geometry.")
      .def_prop_ro(
          "sharp_by_mtf_m",
          [](const L& self) { return self.by_mtf ? nb::object(range_of(*self.by_mtf)) : nb::none(); },
          "(near, far): at half of Nyquist at least 0.8 of the MTF in focus; None where there is none.")
      .def_ro("hyperfocal_m", &L::hyperfocal_m)
      .def_prop_ro("places", places_of,
                   "Middle, half way and corner: dicts with `real_image_height_mm`, `relative_illumination`, "
                   "and the MTF (tangential, sagittal) at `half_nyquist` and `nyquist`.")
      .def("_repr_html_", [](const L& self) { return beside({self}).attr("_repr_html_")(); })
      .def("__repr__", [](const L& self) { return to_text(lens_on_sensor_table({self})); });
  camera.def(
      "on_sensor", on_sensor, nb::arg("distance").none() = nb::none(), nb::kw_only(),
      nb::arg("wavelengths_nm") = Numbers(), nb::arg("threads") = 0, nb::arg("progress").none() = nb::none(),
      "What this lens does for this sensor: an object at `distance` (\"400mm\"; None: at infinity) from "
      "the sensor plane. Light of `wavelengths_nm` alike in weight; none: the lens's.");
  module.def("match_lenses", matched, nb::arg("sensor"), nb::kw_only(), nb::arg("distance"),
             nb::arg("width_mm"), nb::arg("f_number").none() = nb::none(),
             nb::arg("wavelengths_nm") = Numbers(), nb::arg("scaled") = false, nb::arg("threads") = 0,
             nb::arg("progress").none() = nb::none(),
             "The bundled lenses that see `width_mm` at `distance` on the sensor, the best corner first. "
             "`scaled`: lenses may be scaled to fit.");
  module.def("compare_lenses", beside, nb::arg("lenses"),
             "What on_sensor() or match_lenses() gave, beside each other: a Table, a row a quantity.");
}

}  // namespace petzval::python
