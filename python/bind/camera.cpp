// SPDX-License-Identifier: BSD-3-Clause
#include "camera.h"

#include <fmt/format.h>

#include "call.h"
#include "constructor.h"
#include "image.h"

namespace petzval::python {

namespace {

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
  if (coating.has_films() || !coating.by_angle.empty()) return nb::cast(coating.name);
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

std::string repr(const CameraInPython& c) {
  std::string text = fmt::format("<Camera: lens {}, focus {}",
                                 c.lens ? "'" + c.lens->name + "'" : "of the scene", c.focus.text());
  if (c.f_number) text += fmt::format(", f/{:g}", *c.f_number);
  if (c.sensor) text += fmt::format(", sensor '{}'", c.sensor->name);
  return text + ">";
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
  nb::class_<TableCamera> table_camera = bind_table_camera(module);
  using C = CameraInPython;
  nb::class_<C> c(module, "Camera", nb::type_slots(explained_constructor),
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
  bind_table(module);
  bind_image(c, table_camera, module);
  bind_clip(c, table_camera, module);
  bind_render(c, module);
  bind_selection(c, module);
}

}  // namespace petzval::python
