// SPDX-License-Identifier: BSD-3-Clause
#include "camera.h"

#include <fmt/format.h>
#include <petzval/optics/table_file.h>
#include <petzval/simulate/imaging_session.h>

#include "call.h"
#include "scene.h"

namespace petzval::python {

namespace {

template <typename Number>
using Maybe = std::optional<Number>;

using ApertureWords = std::initializer_list<std::pair<std::string_view, Camera::Apertures>>;
const ApertureWords aperture_words{{"file", Camera::Apertures::as_given},
                                   {"from-fields", Camera::Apertures::from_fields},
                                   {"ignored", Camera::Apertures::ignored}};

Focus focus_from(const nb::object& focus) {
  return focus.is_none() ? Focus::automatic() : Focus::parse(nb::cast<std::string>(nb::str(focus)));
}

Maybe<StopBlades> blades_from(const nb::object& blades) {
  if (blades.is_none()) return {};
  StopBlades result;
  if (nb::isinstance<nb::int_>(blades))
    result.count = nb::cast<int>(blades);
  else
    std::tie(result.count, result.rotation_deg) = nb::cast<std::pair<int, double>>(blades);
  result.validate();
  return result;
}

nb::object blades_to(const Maybe<StopBlades>& blades) {
  return blades ? nb::cast(std::pair(blades->count, blades->rotation_deg)) : nb::none();
}

/// One reflectance, a curve (wavelengths, reflectances), or thin films by name or file.
Coating coating_from(const nb::handle& coating) {
  if (PyFloat_Check(coating.ptr()) || PyLong_Check(coating.ptr()))
    return Coating::constant(nb::cast<double>(coating));
  if (nb::isinstance<nb::str>(coating)) {
    const auto text = nb::cast<std::string>(coating);
    Coating films = read_coating(text);
    films.name = text;  // what coating_to() gives back
    return films;
  }
  const auto [nm, values] = nb::cast<std::pair<Numbers, Numbers>>(coating);
  Coating result;
  for (std::size_t i = 0; i < std::min(nm.size(), values.size()); ++i)
    result.table.emplace_back(nm[i], values[i]);
  return result;
}

nb::object coating_to(const Coating& coating) {
  if (coating.has_films()) return nb::cast(coating.name);
  if (coating.table.size() == 1 && coating.table[0].first == 0) return nb::float_(coating.table[0].second);
  Numbers nm, values;
  for (const auto& [wavelength, value] : coating.table) nm.push_back(wavelength), values.push_back(value);
  return nb::make_tuple(tuple_of(nm), tuple_of(values));
}

/// Of all surfaces between air and glass, or {surface: coating}.
void set_coating(CameraInPython& camera, const nb::object& coating) {
  camera.losses.air_glass.reset();
  camera.losses.surfaces.clear();
  if (coating.is_none()) return;
  if (nb::isinstance<nb::dict>(coating)) {
    for (const auto& [surface, each] : dict_of(coating))
      camera.losses.surfaces[nb::cast<std::size_t>(surface)] = coating_from(each);
  } else {
    camera.losses.air_glass = coating_from(coating);
  }
}

nb::object coating_of(const CameraInPython& camera) {
  if (camera.losses.air_glass) return coating_to(*camera.losses.air_glass);
  if (camera.losses.surfaces.empty()) return nb::none();
  nb::dict dict;
  for (const auto& [surface, coating] : camera.losses.surfaces) dict[nb::int_(surface)] = coating_to(coating);
  return nb::steal(PyDictProxy_New(dict.ptr()));
}

CameraInPython camera(const nb::object& lens, const nb::object& focus, Maybe<double> f_number,
                      const nb::object& sensor, const nb::object& blades, Maybe<double> image_distance_mm,
                      double move_lens_mm, const std::string& apertures, bool fresnel, bool absorption,
                      const nb::object& coating, Maybe<double> focus_wavelength_nm, double defocus_mm) {
  CameraInPython result;
  result.lens = lens_from(lens), result.sensor = sensor_from(sensor);
  result.focus = focus_from(focus);
  result.f_number = f_number;
  result.blades = blades_from(blades);
  result.image_distance_mm = image_distance_mm, result.move_lens_mm = move_lens_mm;
  result.focus_wavelength_nm = focus_wavelength_nm, result.defocus_mm = defocus_mm;
  result.apertures = choice("apertures", apertures, aperture_words);
  result.losses.fresnel = fresnel, result.losses.absorption = absorption;
  set_coating(result, coating);
  return result;
}

ImageOptions image_options(const std::string& method, Maybe<double> tolerance, int supersample,
                           const std::string& surround, const std::string& interpolate,
                           const std::string& fit, Maybe<int> section, int layers,
                           Maybe<double> least_scene_angle_deg) {
  ImageOptions options;
  ImagingOptions& imaging = options.imaging;
  imaging.method = choice<BlurMethod>("method", method,
                                      {{"product", BlurMethod::product},
                                       {"blended", BlurMethod::blended},
                                       {"sections", BlurMethod::sections},
                                       {"exact", BlurMethod::exact},
                                       {"none", BlurMethod::none}});
  if (tolerance) imaging.product.tolerance = *tolerance;
  if (section) imaging.sections.section = *section;
  imaging.supersample = supersample;
  imaging.surround =
      choice<Surround>("surround", surround,
                       {{"error", Surround::error}, {"zero", Surround::zero}, {"extend", Surround::extend}});
  imaging.interpolation = choice<PsfInterpolation>(
      "interpolate", interpolate, {{"psf", PsfInterpolation::psf}, {"otf", PsfInterpolation::otf}});
  imaging.fit = RadialFit::parse(fit);
  options.depth.layers = layers;
  options.least_scene_angle_deg = least_scene_angle_deg;
  return options;
}

/// The keywords of every way to an image, after those of the scene.
#define PETZVAL_IMAGE_ARGUMENTS                                                                              \
  nb::kw_only(), nb::arg("method") = "product", nb::arg("tolerance").none() = nb::none(),                    \
                 nb::arg("supersample") = 0, nb::arg("surround") = "error", nb::arg("interpolate") = "psf",  \
                 nb::arg("fit") = "monotone", nb::arg("section").none() = nb::none(), nb::arg("layers") = 0, \
                 nb::arg("least_scene_angle_deg").none() = nb::none(),                                       \
                 nb::arg("scatter").none() = nb::none(), nb::arg("scatter_surround") = "dark",               \
                 nb::arg("threads") = 0, nb::arg("progress").none() = nb::none()

SpectralImage image_of(Optics optics, const nb::object& scene, const ImageOptions& options,
                       const CallOptions& how) {
  SceneChoice chosen = scene_from(scene);
  Call call(how);
  return call([&](const Context& context) {
    if (auto* request = std::get_if<SceneRequest>(&chosen))
      return image(*request, std::move(optics), options, context);
    return image(std::get<Scene>(std::move(chosen)), std::move(optics), options, context);
  });
}

ImagePlan plan_of(Optics optics, const nb::object& scene, const ImageOptions& options,
                  const CallOptions& how) {
  SceneChoice chosen = scene_from(scene);
  Call call(how);
  return call([&](const Context& context) {
    if (auto* request = std::get_if<SceneRequest>(&chosen))
      return plan_image(*request, std::move(optics), options, context);
    return plan_image(std::get<Scene>(std::move(chosen)), std::move(optics), options, context);
  });
}

ImagingSession session_of(const nb::object& scene, const std::string& method, Maybe<double> tolerance,
                          int supersample, const std::string& surround, const std::string& interpolate,
                          const std::string& fit, Maybe<int> section, int layers,
                          Maybe<double> least_scene_angle_deg) {
  ImageOptions options = image_options(method, tolerance, supersample, surround, interpolate, fit, section,
                                       layers, least_scene_angle_deg);
  SceneChoice chosen = scene_from(scene);
  if (auto* request = std::get_if<SceneRequest>(&chosen))
    return ImagingSession(std::move(*request), std::move(options));
  return ImagingSession(std::get<Scene>(std::move(chosen)), std::move(options));
}

Optics optics_of(const CameraInPython& camera) {
  if (!camera.lens)
    throw InputError(
        "`lens`: a flat scene is imaged through a lens; Camera(\"edmund-54852\") would be right");
  return camera.value();
}

Optics optics_of(const TableCamera& camera) {
  return camera;
}

template <typename Self>
SpectralImage session_image(ImagingSession& session, const Self& optics, int threads,
                            const nb::object& progress) {
  Call call({threads, 1, progress});
  return call([&](const Context& context) { return session.image(optics_of(optics), context); });
}

template <auto make, typename Self>
auto with_image_options(const Self& self, const nb::object& scene, const std::string& method,
                        Maybe<double> tolerance, int supersample, const std::string& surround,
                        const std::string& interpolate, const std::string& fit, Maybe<int> section,
                        int layers, Maybe<double> least_scene_angle_deg, const Maybe<std::string>& scatter,
                        const std::string& scatter_surround, int threads, const nb::object& progress) {
  using Surround = ScatterLightOptions::Surround;
  ImageOptions options = image_options(method, tolerance, supersample, surround, interpolate, fit, section,
                                       layers, least_scene_angle_deg);
  options.flare.scatter_surround = choice<Surround>("scatter_surround", scatter_surround,
                                                    {{"dark", Surround::dark}, {"mean", Surround::mean}});
  options.flare.scatter = scatter.has_value();
  if (scatter && *scatter != "lens") options.flare.surfaces_scatter = parse_scatter(*scatter);
  return make(optics_of(self), scene, options, {threads, 1, progress});
}

constexpr const char* image_text =
    "The light of a flat scene on the sensor. `scene`: a name, a SceneRequest, or a Scene in memory. "
    "`method` of the blur: "
    "product (to a relative L2 error of `tolerance`, 1e-3), blended, sections, exact or none; `supersample`: "
    "cells along a side of a pixel, 0: as many as the tolerance needs; `surround` of a scene that is too "
    "small: error, zero or extend; `layers` of a scene "
    "with depth, 0: as "
    "many as needed; `scatter` of the lens's surfaces, as roughness=1.5,dust=0.02, or lens for what its file "
    "says (docs/FLARE.md); `scatter_surround` beyond the frame: dark or mean. `progress(fraction, what)` may "
    "return False to stop. Raises InputError; Cancelled.";
constexpr const char* plan_text =
    "What `image` does before it computes light: scene, table of the lens, frame. Takes the same keywords.";

std::string repr(const CameraInPython& c) {
  std::string text = fmt::format("<Camera: lens {}, focus {}",
                                 c.lens ? "'" + c.lens->name + "'" : "of the scene", c.focus.text());
  if (c.f_number) text += fmt::format(", f/{:g}", *c.f_number);
  if (c.sensor) text += fmt::format(", sensor '{}'", c.sensor->name);
  return text + ">";
}

void bind_plan(nb::module_& module) {
  nb::class_<SensorGeometry>(module, "Frame", "Where the pixels are, centred on the axis.")
      .def_ro("columns", &SensorGeometry::columns)
      .def_ro("rows", &SensorGeometry::rows)
      .def_ro("pitch_um", &SensorGeometry::pitch_um)
      .def("__repr__", [](const SensorGeometry& g) {
        return fmt::format("Frame({} x {} at {:g} um)", g.columns, g.rows, g.pitch_um);
      });
  nb::class_<LensDataTable>(module, "LensDataTable",
                            "What a lens does to light by field and wavelength (docs/TABLES.md).")
      .def_static(
          "load", [](const std::string& path) { return read_table(path); }, nb::arg("path"),
          "Reads a .h5 of `petzval optics build`.")
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
  nb::class_<ImagePlan>(module, "ImagePlan", "Scene, table of the lens and frame, made to fit each other.")
      .def_prop_ro(
          "scene", [](ImagePlan& p) -> Scene& { return p.scene; }, nb::rv_policy::reference_internal)
      .def_prop_ro(
          "table", [](ImagePlan& p) -> LensDataTable& { return p.table; }, nb::rv_policy::reference_internal)
      .def_prop_ro("frame", [](const ImagePlan& p) { return p.frame; })
      .def(
          "image",
          [](const ImagePlan& plan, int threads, const nb::object& progress) {
            Call call({threads, 1, progress});
            return call([&](const Context& context) { return image(plan, context); });
          },
          nb::kw_only(), nb::arg("threads") = 0, nb::arg("progress").none() = nb::none(),
          "The light on the sensor.");
  nb::class_<TableCamera>(module, "TableCamera",
                          "A lens data table in the place of a lens, with the sensor behind it.")
      .def(nb::new_([](const LensDataTable& table, const nb::object& sensor) {
             TableCamera camera{table, {}};
             if (const auto chosen = sensor_from(sensor)) camera.sensor = *chosen;
             return camera;
           }),
           nb::arg("table"), nb::arg("sensor").none() = nb::none())
      .def("image", with_image_options<image_of, TableCamera>, nb::arg("scene"), PETZVAL_IMAGE_ARGUMENTS,
           image_text);
  nb::class_<ImagingSession>(
      module, "ImagingSession",
      "One flat scene through one camera after the other. Keeps what an alteration leaves valid: the scene, "
      "the table of the last lens, the last image. Gives the bytes of Camera.image().")
      .def(nb::new_(&session_of), nb::arg("scene"), nb::kw_only(), nb::arg("method") = "product",
           nb::arg("tolerance").none() = nb::none(), nb::arg("supersample") = 0,
           nb::arg("surround") = "error", nb::arg("interpolate") = "psf", nb::arg("fit") = "monotone",
           nb::arg("section").none() = nb::none(), nb::arg("layers") = 0,
           nb::arg("least_scene_angle_deg").none() = nb::none(), "Keywords are those of Camera.image().")
      .def("image", session_image<CameraInPython>, nb::arg("camera"), nb::kw_only(), nb::arg("threads") = 0,
           nb::arg("progress").none() = nb::none(), "The light on the sensor.")
      .def("image", session_image<TableCamera>, nb::arg("camera"), nb::kw_only(), nb::arg("threads") = 0,
           nb::arg("progress").none() = nb::none());
}

}  // namespace

Camera CameraInPython::value() const {
  Camera camera;
  if (lens) {
    lens->validate();
    camera.lens = *lens;
  }
  if (sensor) camera.sensor = *sensor;
  camera.focus = focus, camera.f_number = f_number, camera.blades = blades;
  camera.image_distance_mm = image_distance_mm, camera.move_lens_mm = move_lens_mm;
  camera.focus_wavelength_nm = focus_wavelength_nm, camera.defocus_mm = defocus_mm;
  camera.apertures = apertures, camera.losses = losses;
  return camera;
}

namespace {

bool is_name(const nb::object& word) {
  return nb::isinstance<nb::str>(word) || nb::hasattr(word, "__fspath__");
}

}  // namespace

std::shared_ptr<Lens> lens_from(const nb::object& lens) {
  if (lens.is_none()) return nullptr;
  if (is_name(lens)) return nb::cast<std::shared_ptr<Lens>>(nb::type<Lens>()(nb::str(lens)));
  if (nb::isinstance<Lens>(lens)) return nb::cast<std::shared_ptr<Lens>>(lens);
  throw nb::type_error("`lens`: a name, a path or a Lens would be right");
}

std::shared_ptr<Sensor> sensor_from(const nb::object& sensor) {
  if (sensor.is_none()) return nullptr;
  if (is_name(sensor)) return std::make_shared<Sensor>(read_sensor(nb::cast<std::string>(nb::str(sensor))));
  if (nb::isinstance<Sensor>(sensor)) return nb::cast<std::shared_ptr<Sensor>>(sensor);
  throw nb::type_error("`sensor`: a name, a path, a Sensor, or 768x576@6.25 would be right");
}

Lens lens_to_look_at(const nb::object& lens_or_camera) {
  if (nb::isinstance<Lens>(lens_or_camera)) {
    const auto& lens = nb::cast<const Lens&>(lens_or_camera);
    lens.validate();  // Python may have altered any number of it
    return lens;
  }
  if (!nb::isinstance<CameraInPython>(lens_or_camera))
    throw nb::type_error("a Lens or a Camera would be right");
  const Camera camera = std::get<Camera>(optics_of(nb::cast<const CameraInPython&>(lens_or_camera)));
  Call call;
  return call([&](const Context& context) { return lens_in_use(camera, context); });
}

void bind_camera(nb::module_& module) {
  bind_plan(module);
  using C = CameraInPython;
  nb::class_<C> c(module, "Camera",
                  "A lens, how it is used, and the sensor behind it. It refers to its lens: what alters the "
                  "lens alters the camera.");
  c.def(nb::new_(&camera), nb::arg("lens").none() = nb::none(), nb::kw_only(),
        nb::arg("focus").none() = "auto", nb::arg("f_number").none() = nb::none(),
        nb::arg("sensor").none() = nb::none(), nb::arg("blades").none() = nb::none(),
        nb::arg("image_distance_mm").none() = nb::none(), nb::arg("move_lens_mm") = 0.0,
        nb::arg("apertures") = "file", nb::arg("fresnel") = false, nb::arg("absorption") = false,
        nb::arg("coating").none() = nb::none(), nb::arg("focus_wavelength_nm").none() = nb::none(),
        nb::arg("defocus_mm") = 0.0,
        "`lens` and `sensor`: objects or names; None: those of a three-dimensional scene, what fits a flat "
        "one. `focus`: auto, design, "
        "infinity, a distance with its unit (1.2m, 250mm), best-spot or best-mtf@40. `f_number`: paraxial, "
        "at infinity. `blades`: a number "
        "or (number, rotation [degrees]). `apertures` that the lens leaves out: file (unbounded) or "
        "from-fields; ignored: nothing but the "
        "stop clips. `coating`: reflectance between air and glass, or {surface: reflectance}; a reflectance "
        "is a number or (wavelengths, values).")
      .def_prop_rw(
          "lens", [](const C& c) { return c.lens; },
          [](C& c, const nb::object& lens) { c.lens = lens_from(lens); },
          nb::for_setter(nb::arg("value").none()))
      .def_prop_rw(
          "sensor", [](const C& c) { return c.sensor; },
          [](C& c, const nb::object& sensor) { c.sensor = sensor_from(sensor); },
          nb::for_setter(nb::arg("value").none()))
      .def_prop_rw(
          "focus", [](const C& c) { return c.focus.text(); },
          [](C& c, const nb::object& focus) { c.focus = focus_from(focus); },
          nb::for_setter(nb::arg("value").none()),
          "auto, design, infinity, a distance (1.2m), best-spot, best-mtf@40.")
      .def_rw("f_number", &C::f_number, nb::for_setter(nb::arg("value").none()),
              "Paraxial, at infinity; None: as the lens has it.")
      .def_prop_rw(
          "blades", [](const C& c) { return blades_to(c.blades); },
          [](C& c, const nb::object& blades) { c.blades = blades_from(blades); },
          nb::for_setter(nb::arg("value").none()))
      .def_rw("image_distance_mm", &C::image_distance_mm, nb::for_setter(nb::arg("value").none()),
              "From the last vertex to the sensor, in place of a focus; None: as the focus says.")
      .def_rw("move_lens_mm", &C::move_lens_mm, "The whole lens towards the object [mm].")
      .def_rw(
          "focus_wavelength_nm", &C::focus_wavelength_nm, nb::for_setter(nb::arg("value").none()),
          "That is brought to focus [nm]; None: the lens's own, or the light in use where that is another.")
      .def_rw("defocus_mm", &C::defocus_mm, "Of the sensor from its focus, away from the lens [mm].")
      .def_prop_rw(
          "apertures", [](const C& c) { return std::string(word_of(c.apertures, aperture_words)); },
          [](C& c, const std::string& word) { c.apertures = choice("apertures", word, aperture_words); })
      .def_prop_rw(
          "fresnel", [](const C& c) { return c.losses.fresnel; },
          [](C& c, bool on) { c.losses.fresnel = on; })
      .def_prop_rw(
          "absorption", [](const C& c) { return c.losses.absorption; },
          [](C& c, bool on) { c.losses.absorption = on; })
      .def_prop_rw("coating", coating_of, set_coating, nb::for_setter(nb::arg("value").none()),
                   "Of the surfaces between air and glass: a reflectance, a curve (wavelengths_nm, "
                   "reflectances), or thin "
                   "films by name or file (\"mgf2\"); or {surface: one of these}. None: bare glass.")
      .def("image", with_image_options<image_of, C>, nb::arg("scene"), PETZVAL_IMAGE_ARGUMENTS, image_text)
      .def("plan", with_image_options<plan_of, C>, nb::arg("scene"), PETZVAL_IMAGE_ARGUMENTS, plan_text)
      .def(
          "lens_in_use",
          [](nb::handle self) { return std::make_shared<Lens>(lens_to_look_at(nb::borrow(self))); },
          "The lens stopped down, moved and focused, as a lens program would look at it.")
      .def("__repr__", repr)
      .def("__reduce__", [](const C& c) {
        return nb::make_tuple(
            nb::module_::import_("petzval._states").attr("camera"),
            nb::make_tuple(c.lens, c.sensor, c.focus.text(), c.f_number, blades_to(c.blades),
                           c.image_distance_mm, c.move_lens_mm,
                           std::string(word_of(c.apertures, aperture_words)), c.losses.fresnel,
                           c.losses.absorption,
                           c.losses.surfaces.empty() ? coating_of(c) : nb::object(dict_of(coating_of(c))),
                           c.focus_wavelength_nm, c.defocus_mm));
      });
  module.def(
      "_camera_from_state",
      [](const nb::object& lens, const nb::object& sensor, const nb::object& focus, Maybe<double> f_number,
         const nb::object& blades, Maybe<double> image_distance_mm, double move_lens_mm,
         const std::string& apertures, bool fresnel, bool absorption, const nb::object& coating,
         Maybe<double> focus_wavelength_nm, double defocus_mm) {
        return camera(lens, focus, f_number, sensor, blades, image_distance_mm, move_lens_mm, apertures,
                      fresnel, absorption, coating, focus_wavelength_nm, defocus_mm);
      },
      nb::arg().none(), nb::arg().none(), nb::arg(), nb::arg().none(), nb::arg().none(), nb::arg().none(),
      nb::arg(), nb::arg(), nb::arg(), nb::arg(), nb::arg().none(), nb::arg().none(), nb::arg());
  bind_render(c, module);
  bind_selection(c, module);
}

}  // namespace petzval::python
