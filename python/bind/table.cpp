// SPDX-License-Identifier: BSD-3-Clause
// Lens data tables, and cameras that have one in the place of a lens.
#include <fmt/format.h>
#include <petzval/optics/build.h>
#include <petzval/optics/table_file.h>

#include "call.h"
#include "camera.h"
#include "constructor.h"
#include "image.h"

namespace petzval::python {

namespace {

LensDataTable built(const CameraInPython& self, const Numbers& wavelengths_nm, Maybe<double> image_height_mm,
                    int fields, int places, bool over_frame, int threads, const nb::object& progress) {
  const Camera camera = std::get<Camera>(optics_of(self));
  TableOptions options;
  options.wavelengths_nm = wavelengths_nm;
  options.field_count = fields, options.frame_places = places;
  if (camera.apertures == Camera::Apertures::ignored) options.clip = Tracer::Clip::stop_only;
  options.losses = camera.losses;
  if (image_height_mm && !(*image_height_mm > 0))
    throw InputError(fmt::format("`image_height_mm` {}; a positive length would be right", *image_height_mm));
  if (image_height_mm) {
    options.max_image_height_mm = *image_height_mm;
  } else if (camera.sensor) {
    const SensorGeometry& frame = camera.sensor->geometry;
    options.max_image_height_mm = frame.half_diagonal_mm();
    options.half_frame_mm = {frame.width_mm() / 2, frame.height_mm() / 2};
  }
  if (over_frame) options.places = TableOptions::Places::over_frame;
  options.validate();
  Call call({threads, 1, progress});
  return call([&](const Context& context) {
    return result_within(context, [&](const ProgressCallback& told) {
      return build_lens_data_table(lens_in_use(camera, context), options, told);
    });
  });
}

constexpr const char* built_text =
    "Computes the table of a camera's lens as it is used, as `petzval optics build` does; focus \"auto\" is "
    "that of the design. It reaches the corner of the camera's sensor, or `image_height_mm`, or else the "
    "lens's largest field. `wavelengths_nm`: none: the lens's own. `fields`: how many, the axis included. "
    "`places`: how many along the longer side of a table `over_frame`, which lenses with poses or blades "
    "need. "
    "Raises InputError; Cancelled.";

void bind_table_itself(nb::module_& module) {
  nb::class_<LensDataTable>(module, "LensDataTable",
                            "What a lens does to light by field and wavelength (docs/TABLES.md).")
      .def_static(
          "load", [](const std::string& path) { return read_table(path); }, nb::arg("path"),
          "Reads a .h5 of `petzval optics build`.")
      .def_static("build", built, nb::arg("camera"), nb::kw_only(), nb::arg("wavelengths_nm") = Numbers(),
                  nb::arg("image_height_mm").none() = nb::none(),
                  nb::arg("fields") = TableOptions().field_count,
                  nb::arg("places") = TableOptions().frame_places, nb::arg("over_frame") = false,
                  PETZVAL_CALL_KEYWORDS, built_text)
      .def(
          "save", [](const LensDataTable& t, const std::string& path) { write_table(t, path); },
          nb::arg("path"))
      .def_ro("lens_name", &LensDataTable::lens_name)
      .def_prop_ro("field_unit", &LensDataTable::field_unit, "\"deg\" or \"mm\".")
      .def_prop_ro("fields", [](const LensDataTable& t) { return array_of(t.fields); })
      .def_prop_ro("wavelengths_nm", [](const LensDataTable& t) { return array_of(t.wavelengths_nm); })
      .def_prop_ro(
          "real_image_height_mm",
          [](const LensDataTable& t) {
            return array_of(t.real_image_height_mm, {t.fields.size(), t.wavelengths_nm.size()});
          },
          "(field, wavelength)")
      .def_prop_ro(
          "g_source_sr",
          [](const LensDataTable& t) {
            return array_of(t.g_source_sr, {t.places(), t.wavelengths_nm.size()});
          },
          "(field, wavelength)")
      .def_prop_ro(
          "g_sensor_sr",
          [](const LensDataTable& t) {
            return array_of(t.g_sensor_sr, {t.places(), t.wavelengths_nm.size()});
          },
          "(field, wavelength)")
      .def_prop_ro(
          "over_frame", [](const LensDataTable& t) { return t.frame.has_value(); },
          "Whether places lie over the frame in two dimensions; then fields and heights are empty, and "
          "what is by field is by place, row by row.")
      .def_prop_ro(
          "image_x_mm",
          [](const LensDataTable& t) { return array_of(t.frame ? t.frame->x_mm : std::vector<double>()); },
          "Places along x', of a table over the frame.")
      .def_prop_ro(
          "image_y_mm",
          [](const LensDataTable& t) { return array_of(t.frame ? t.frame->y_mm : std::vector<double>()); },
          "Places along y', of a table over the frame.")
      .def("__repr__", [](const LensDataTable& t) {
        return fmt::format("<LensDataTable of '{}': {} {}, {} wavelengths>", t.lens_name, t.places(),
                           t.frame ? "places" : "fields", t.wavelengths_nm.size());
      });
}

}  // namespace

void bind_table(nb::module_& module) {
  bind_table_itself(module);
}

nb::class_<TableCamera> bind_table_camera(nb::module_& module) {
  nb::class_<TableCamera> camera(module, "TableCamera", nb::type_slots(explained_constructor),
                                 "A lens data table in the place of a lens, with the sensor behind it.");
  camera.def(nb::new_([](const LensDataTable& table, const nb::object& sensor) {
               TableCamera made{table, {}};
               if (const auto chosen = sensor_from(sensor)) made.sensor = *chosen;
               return made;
             }),
             nb::arg("table"), nb::arg("sensor").none() = nb::none());
  return camera;
}

}  // namespace petzval::python
