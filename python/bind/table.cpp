// SPDX-License-Identifier: BSD-3-Clause
// Lens data tables, and cameras that have one in the place of a lens.
#include <fmt/format.h>
#include <petzval/optics/table_export.h>
#include <petzval/optics/table_file.h>
#include <petzval/optics/table_import.h>
#include <petzval/simulate/camera_table.h>

#include "call.h"
#include "camera.h"
#include "constructor.h"
#include "image.h"

namespace petzval::python {

namespace {

LensDataTable built(const CameraInPython& self, const Numbers& wavelengths_nm, Maybe<double> image_height_mm,
                    Maybe<int> fields, double tolerance, int places, bool over_frame, int threads,
                    const nb::object& progress) {
  const Camera camera = std::get<Camera>(optics_of(self));
  CameraTableOptions options{wavelengths_nm, image_height_mm, fields, tolerance, places};
  if (over_frame) options.places = TableOptions::Places::over_frame;
  Call call({threads, 1, progress});
  return call([&](const Context& context) { return camera_table(camera, options, context); });
}

constexpr const char* built_text =
    "Computes the table of a camera's lens as it is used, as `petzval optics build` does; focus \"auto\" is "
    "that of the design. It reaches the corner of the camera's sensor, or `image_height_mm`, or else the "
    "lens's largest field. `wavelengths_nm`: none: the lens's own. `fields`: how many, evenly spaced, the "
    "axis included; None: 31, and those between them that pictures on the "
    "camera's sensor need to `tolerance`. "
    "`places`: how many along the longer side of a table `over_frame`, which lenses with poses or blades "
    "need. "
    "Raises InputError; Cancelled.";

/// HDF5 has one state a process: the GIL stays held while files are read and written.
void tell(const std::string& path, const std::vector<std::string>& notes) {
  Call call;
  call([&](const Context& context) {
    for (const std::string& text : notes)
      if (context.note) context.note(fmt::format("{}: {}", path, text));
  });
}

LensDataTable imported(const std::string& path, const std::string& source,
                       const std::optional<std::string>& psf_away, Maybe<std::pair<int, int>> psf_centre,
                       Maybe<double> g_axis_sr, const std::string& relative_illumination,
                       Maybe<double> vertex_to_sensor_mm, const std::optional<std::string>& curves,
                       bool clip_negative) {
  TableImport how;
  how.source = choice<TableSource>("source", source,
                                   {{"auto", TableSource::automatic},
                                    {"iset", TableSource::iset},
                                    {"zemax", TableSource::zemax},
                                    {"codev", TableSource::codev},
                                    {"measured", TableSource::measured},
                                    {"map", TableSource::map},
                                    {"hdf5", TableSource::hdf5}});
  if (psf_away)
    how.lie.away = choice<PsfAway>(
        "psf_away", *psf_away,
        {{"up", PsfAway::up}, {"down", PsfAway::down}, {"left", PsfAway::left}, {"right", PsfAway::right}});
  if (psf_centre && (psf_centre->first < 1 || psf_centre->second < 1))
    throw InputError(fmt::format("`psf_centre` ({}, {}); row and column, counted from 1, would be right",
                                 psf_centre->first, psf_centre->second));
  how.lie.centre = psf_centre;
  for (const auto& [name, value] :
       {std::pair{"g_axis_sr", g_axis_sr}, {"vertex_to_sensor_mm", vertex_to_sensor_mm}})
    if (value && !(*value > 0))
      throw InputError(fmt::format("`{}` {}; above 0 would be right", name, *value));
  using Illumination = RayTraceReading::Illumination;
  how.reading = {g_axis_sr,
                 choice<Illumination>("relative_illumination", relative_illumination,
                                      {{"sensor", Illumination::sensor}, {"source", Illumination::source}}),
                 vertex_to_sensor_mm.value_or(0)};
  how.curves = curves.value_or("");
  how.measured.clip_negative = clip_negative;
  ImportedTable table = import_table(path, how);
  tell(path, table.notes);
  return std::move(table.table);
}

constexpr const char* imported_text =
    "Reads a table of another program, as `petzval optics import` does (docs/TABLES.md). `source`: auto (by "
    "the name), iset (a MAT file), zemax or codev (a folder of text files), measured (a CSV file of PSFs or "
    "MTFs), map (an .npz file of PSFs over the frame), hdf5 (the layout of a .h5 without its checksum). What "
    "the file does not say: `psf_away`, the "
    "direction in its PSFs that is away from the axis (up, down, left, right), `psf_centre`, the sample of "
    "the chief ray (row, column, from 1), `g_axis_sr`, `vertex_to_sensor_mm`; `relative_illumination` is of "
    "a wall (sensor) or of an object point (source). Of measurements: `curves`, a CSV file of distortion "
    "and illumination, and `clip_negative`, which takes values below zero for noise. Raises InputError.";

void exported(const LensDataTable& table, const std::string& path, const std::string& to, bool resample,
              Maybe<double> psf_spacing_um, Maybe<int> psf_size, Maybe<double> psf_light) {
  const auto target =
      choice<TableTarget>("to", to, {{"iset", TableTarget::iset}, {"zemax", TableTarget::zemax}});
  tell(path, export_table(table, target, path, {resample, psf_spacing_um, psf_size, psf_light}));
}

constexpr const char* exported_text =
    "Writes the table for another program, as `petzval optics export` does. `to`: iset (a MAT file of "
    "ISETCam) or zemax (a folder of text files). Both need all PSFs on one grid: `resample` brings them "
    "there, with `psf_spacing_um` [um] and `psf_size` samples a side if given; each PSF keeps at least the "
    "share `psf_light` of its light (0.99). Raises InputError; Failure.";

void bind_table_itself(nb::module_& module) {
  nb::class_<LensDataTable>(module, "LensDataTable",
                            "What a lens does to light by field and wavelength (docs/TABLES.md).")
      .def_static(
          "load", [](const std::string& path) { return read_table(path); }, nb::arg("path"),
          "Reads a .h5 of `petzval optics build`.")
      .def_static("build", built, nb::arg("camera"), nb::kw_only(), nb::arg("wavelengths_nm") = Numbers(),
                  nb::arg("image_height_mm").none() = nb::none(), nb::arg("fields").none() = nb::none(),
                  nb::arg("tolerance") = CameraTableOptions().tolerance,
                  nb::arg("places") = TableOptions().frame_places, nb::arg("over_frame") = false,
                  PETZVAL_CALL_KEYWORDS, built_text)
      .def_static("import_from", imported, nb::arg("path"), nb::kw_only(), nb::arg("source") = "auto",
                  nb::arg("psf_away").none() = nb::none(), nb::arg("psf_centre").none() = nb::none(),
                  nb::arg("g_axis_sr").none() = nb::none(), nb::arg("relative_illumination") = "sensor",
                  nb::arg("vertex_to_sensor_mm").none() = nb::none(), nb::arg("curves").none() = nb::none(),
                  nb::arg("clip_negative") = false, imported_text)
      .def(
          "save", [](const LensDataTable& t, const std::string& path) { write_table(t, path); },
          nb::arg("path"), "Writes a .h5, as `petzval optics build` does.")
      .def("export", exported, nb::arg("path"), nb::kw_only(), nb::arg("to"), nb::arg("resample") = false,
           nb::arg("psf_spacing_um").none() = nb::none(), nb::arg("psf_size").none() = nb::none(),
           nb::arg("psf_light").none() = nb::none(), exported_text)
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
