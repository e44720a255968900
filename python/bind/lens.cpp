// SPDX-License-Identifier: BSD-3-Clause
#include "lens.h"

#include <petzval/analysis/field_values.h>
#include <petzval/analysis/transfer_fit.h>
#include <petzval/lens/lens_states.h>
#include <petzval/lens/reversed_lens.h>
#include <petzval/lens/scaled_lens.h>

#include <cmath>
#include <variant>

#include "constructor.h"
#include "glass.h"
#include "lens_parts.h"
#include "surface.h"

namespace petzval::python {

namespace {

using ApertureWords = std::initializer_list<std::pair<std::string_view, Aperture::Kind>>;
const ApertureWords aperture_words{{"f_number", Aperture::Kind::f_number},
                                   {"working_f_number", Aperture::Kind::working_f_number},
                                   {"image_na", Aperture::Kind::image_na},
                                   {"object_na", Aperture::Kind::object_na},
                                   {"entrance_pupil_diameter_mm", Aperture::Kind::entrance_pupil_diameter_mm},
                                   {"stop_semi_diameter_mm", Aperture::Kind::stop_semi_diameter_mm}};

nb::object aperture_of(const Lens& lens) {
  nb::dict dict;
  const std::string name(word_of(lens.aperture.kind, aperture_words));
  dict[name.c_str()] = lens.aperture.value;
  return nb::steal(PyDictProxy_New(dict.ptr()));
}

Aperture aperture_from(const nb::dict& dict) {
  if (dict.size() != 1) throw InputError("`aperture` has one entry, as in {\"f_number\": 5.6}");
  for (const auto& [key, value] : dict)
    return {choice("aperture", nb::cast<std::string>(key), aperture_words), nb::cast<double>(value)};
  return {};
}

nb::object fields_of(const Lens& lens) {
  nb::dict dict;
  dict["type"] = to_string(lens.fields.kind);
  dict["values"] = tuple_of(lens.fields.values);
  return nb::steal(PyDictProxy_New(dict.ptr()));
}

Fields fields_from(const nb::dict& dict) {
  if (dict.size() != 2 || !dict.contains("type") || !dict.contains("values"))
    throw InputError("`fields` has a type and values, as in {\"type\": \"angle_deg\", \"values\": [0, 10]}");
  return {field_kind_of(nb::cast<std::string>(dict["type"])), nb::cast<Numbers>(dict["values"])};
}

std::shared_ptr<Lens> lens_in_python(const nb::iterable& surfaces, const nb::dict& aperture,
                                     const nb::object& fields, const Numbers& wavelengths_nm,
                                     std::optional<double> reference_wavelength_nm,
                                     std::optional<double> object_distance_mm, const std::string& name) {
  auto lens = std::make_shared<Lens>();
  lens->surfaces = surfaces_from(surfaces);
  lens->aperture = aperture_from(aperture);
  if (!fields.is_none()) lens->fields = fields_from(dict_of(fields));
  if (!wavelengths_nm.empty()) lens->wavelengths_nm = wavelengths_nm;
  const Numbers& all = lens->wavelengths_nm;
  lens->reference_wavelength_nm = reference_wavelength_nm.value_or(all[all.size() / 2]);
  lens->object_distance_mm = object_distance_mm;
  lens->name = name;
  lens->validate();
  return lens;
}

/// Notes of readers, as warnings.
void warn(const std::vector<std::string>& notes) {
  Call call;
  call([&](const Context& context) {
    for (const std::string& note : notes) send_note(context, note);
    return true;
  });
}

std::shared_ptr<Lens> read(const std::string& name, const std::map<std::string, std::string>& substitutions,
                           const std::optional<GlassCatalogue>& glasses) {
  LensFile file = read_lens(name, {.substitutions = substitutions, .glasses = glasses});
  warn(file.notes);
  return std::make_shared<Lens>(std::move(file.lens));
}

/// Where the glasses of a lens are found again: those that it has, then the bundled ones.
GlassCatalogue glasses_of(const Lens& lens) {
  std::vector<Glass> own;
  for (const Surface& surface : lens.surfaces)
    if (const auto* glass = std::get_if<std::shared_ptr<const Glass>>(&surface.material.kind()))
      if (std::ranges::none_of(own, [&](const Glass& g) { return g.full_name() == (*glass)->full_name(); }))
        own.push_back(**glass);
  return GlassCatalogue::bundled().with(std::move(own));
}

std::string setting(const std::string& path, const nb::object& value) {
  return path + "=" + nb::cast<std::string>(call_python("json", "dumps", value));
}

nb::object optional_distance(std::optional<double> value) {
  return value ? nb::cast(*value) : nb::none();
}

std::shared_ptr<Lens> scaled(const Lens& lens, Maybe<double> factor, Maybe<double> efl_mm) {
  if (factor.has_value() == efl_mm.has_value())
    throw InputError("a lens is scaled either by a `factor` or to an `efl_mm`; one of them would be right");
  const double by = factor ? *factor : *efl_mm / std::abs(first_order(lens).efl_mm);
  auto result = std::make_shared<Lens>(scaled_lens(lens, by));
  result->name = fmt::format("{}, scaled by {:.4g}", lens.name, by);
  return result;
}

std::string repr(const Lens& lens) {
  return fmt::format("<Lens '{}': {} surfaces, {}>", lens.name, lens.surfaces.size(),
                     nb::cast<std::string>(nb::repr(dict_of(aperture_of(lens)))));
}

FirstOrder paraxial(const Lens& lens, std::optional<double> wavelength_nm) {
  lens.validate();  // Python may have altered any number of it
  return first_order(lens, wavelength_nm);
}

/// A number of FirstOrder as a property of the lens, at its reference wavelength.
template <double FirstOrder::*member>
double first_order_number(const Lens& lens) {
  return paraxial(lens, {}).*member;
}

void bind_first_order(nb::module_& module) {
  nb::class_<PupilData>(module, "PupilData", "Place and size of a pupil [mm].")
      .def_ro("position_mm", &PupilData::position_mm,
              "Entrance: from vertex 1; exit: from the image surface.")
      .def_ro("diameter_mm", &PupilData::diameter_mm)
      .def("__repr__", [](const PupilData& p) {
        return fmt::format("PupilData(position_mm={}, diameter_mm={})", number_repr(p.position_mm),
                           number_repr(p.diameter_mm));
      });
  nb::class_<FirstOrder> c(module, "FirstOrder",
                           "Paraxial optics of a lens at one wavelength. Lengths in mm.");
  std::vector<std::string> names;
  const auto number = [&](const char* name, double FirstOrder::*member, const char* text) {
    c.def_ro(name, member, text);
  };
  number("wavelength_nm", &FirstOrder::wavelength_nm, "");
  number("efl_mm", &FirstOrder::efl_mm, "Focal length.");
  number("bfl_mm", &FirstOrder::bfl_mm, "Last vertex to rear focal point.");
  number("ffl_mm", &FirstOrder::ffl_mm, "Vertex 1 to front focal point.");
  number("f_number", &FirstOrder::f_number, "At infinity.");
  number("working_f_number", &FirstOrder::working_f_number, "At the object distance.");
  number("image_space_na", &FirstOrder::image_space_na, "At the object distance.");
  number("field_of_view_deg", &FirstOrder::field_of_view_deg, "Full angle of the largest field of the file.");
  number("magnification", &FirstOrder::magnification, "0 for an object at infinity.");
  number("petzval_radius_mm", &FirstOrder::petzval_radius_mm, "Infinite for a flat field.");
  number("total_track_mm", &FirstOrder::total_track_mm, "Vertex 1 to image surface.");
  number("paraxial_image_mm", &FirstOrder::paraxial_image_mm, "Last vertex to the paraxial image.");
  number("stop_semi_diameter_mm", &FirstOrder::stop_semi_diameter_mm, "");
  number("lagrange_invariant_mm", &FirstOrder::lagrange_invariant_mm, "");
  c.def_ro("entrance_pupil", &FirstOrder::entrance_pupil).def_ro("exit_pupil", &FirstOrder::exit_pupil);
  c.def("__repr__", [](const FirstOrder& f) {
    return fmt::format("<FirstOrder at {:g} nm: efl_mm={:.6g}, f_number={:.4g}, bfl_mm={:.6g}>",
                       f.wavelength_nm, f.efl_mm, f.f_number, f.bfl_mm);
  });
}

}  // namespace

Fields::Kind field_kind_of(std::string_view word) {
  using Kind = Fields::Kind;
  return choice<Kind>("field_type", word,
                      {{"angle_deg", Kind::angle_deg},
                       {"object_height_mm", Kind::object_height_mm},
                       {"paraxial_image_height_mm", Kind::paraxial_image_height_mm},
                       {"real_image_height_mm", Kind::real_image_height_mm}});
}

void bind_lens(nb::module_& module) {
  bind_surface(module);
  bind_first_order(module);
  nb::class_<Lens> lens(module, "Lens", nb::type_slots(explained_constructor),
                        "A lens prescription: surfaces front to back, and what it is used for. Lengths in "
                        "mm, wavelengths in nm.");
  lens.def(nb::new_(&read), nb::arg("name"), nb::kw_only(),
           nb::arg("substitutions") = std::map<std::string, std::string>(),
           nb::arg("glasses").none() = nb::none(),
           "A bundled lens by name, or a file: .json, .zmx, .seq, .dat. `substitutions` of glasses: "
           "{\"LAK10C\": "
           "\"CDGM:H-LAK10\"} or {\"SK1\": \"1.61025/56.71\"}. `glasses`: a GlassCatalogue with your own. "
           "Raises InputError with file and line.")
      .def(nb::new_(&lens_in_python), nb::kw_only(), nb::arg("surfaces"), nb::arg("aperture"),
           nb::arg("fields").none() = nb::none(), nb::arg("wavelengths_nm") = Numbers(),
           nb::arg("reference_wavelength_nm").none() = nb::none(),
           nb::arg("object_distance_mm").none() = nb::none(), nb::arg("name") = "",
           "A lens of these Surfaces. `aperture`: {\"f_number\": 5.6}; `fields`: {\"type\": \"angle_deg\", "
           "\"values\": [0, 10]}. "
           "Raises InputError for what no lens has.")
      .def_rw("name", &Lens::name)
      .def_rw("source", &Lens::source, "Where the numbers come from.")
      .def_prop_rw(
          "surfaces", [](std::shared_ptr<Lens> self) { return SurfaceList{std::move(self)}; },
          [](Lens& self, const nb::iterable& surfaces) { self.surfaces = surfaces_from(surfaces); },
          "Surfaces front to back; altering one alters the lens.")
      .def_prop_rw(
          "aperture", aperture_of,
          [](Lens& self, const nb::dict& dict) { self.aperture = aperture_from(dict); },
          "How wide the lens is open, {\"f_number\": 1.8}; assign a whole dict.")
      .def_prop_rw(
          "fields", fields_of, [](Lens& self, const nb::dict& dict) { self.fields = fields_from(dict); },
          "{\"type\": …, \"values\": …} of the fields that count; assign a whole dict.")
      .def_prop_rw(
          "wavelengths_nm", [](const Lens& self) { return tuple_of(self.wavelengths_nm); },
          [](Lens& self, const Numbers& values) { self.wavelengths_nm = values; })
      .def_rw("reference_wavelength_nm", &Lens::reference_wavelength_nm)
      .def_prop_rw(
          "object_distance_mm", [](const Lens& self) { return optional_distance(self.object_distance_mm); },
          [](Lens& self, std::optional<double> d) {
            self.object_distance_mm = d && std::isinf(*d) ? std::nullopt : d;
          },
          nb::for_setter(nb::arg("value").none()), "From the object to vertex 1; None: infinity.")
      .def_prop_rw(
          "object_glass", [](const Lens& self) { return self.object_material; },
          [](Lens& self, const nb::object& glass) { self.object_material = material_from(glass); },
          nb::for_setter(nb::arg("value").none()),
          "What the object is immersed in; a name, a Glass, or None for air is taken.")
      .def_prop_rw(
          "groups", [](const Lens& self) { return groups_to(self.groups); },
          [](Lens& self, const nb::iterable& groups) { self.groups = groups_from(groups); },
          "Neighbouring surfaces that stand off their places as one: ({\"surfaces\": (2, 3), \"pose\": "
          "{\"tilt_x_deg\": 0.1}, \"pivot_mm\": 0},); assign a whole sequence.")
      .def_prop_rw(
          "sensor_pose", [](const Lens& self) { return pose_to(self.sensor_pose); },
          [](Lens& self, const nb::object& pose) { self.sensor_pose = pose_from(dict_of(pose)); },
          "How far the image surface stands off its place, as `pose` of a Surface; assign a whole dict.")
      .def_prop_rw(
          "tolerances", [](const Lens& self) { return tolerances_to(self.tolerances); },
          [](Lens& self, const std::vector<std::string>& texts) { self.tolerances = tolerances_from(texts); },
          "That its maker keeps, as (\"element_tilt_deg@2-3=0.05\",); assign a whole sequence.")
      .def_prop_ro("total_track_mm", &Lens::total_track_mm, "From vertex 1 to the image surface.")
      .def_prop_ro("efl_mm", first_order_number<&FirstOrder::efl_mm>,
                   "Focal length at the reference wavelength.")
      .def_prop_ro("bfl_mm", first_order_number<&FirstOrder::bfl_mm>, "Last vertex to rear focal point.")
      .def_prop_ro("f_number", first_order_number<&FirstOrder::f_number>, "Paraxial, at infinity.")
      .def("first_order", paraxial, nb::arg("wavelength_nm").none() = nb::none(),
           "Paraxial optics at a wavelength; None: the reference wavelength.")
      .def("validate", &Lens::validate, "Raises InputError that says which entry is wrong.")
      .def(
          "altered",
          [](const Lens& self, const std::string& path, const nb::object& value) {
            return std::make_shared<Lens>(
                with_setting(self, setting(path, value), {.glasses = glasses_of(self)}));
          },
          nb::arg("path"), nb::arg("value").none(),
          "A copy with one entry of its native file altered: altered(\"surfaces[4].thickness_mm\", 0.7).")
      .def_prop_ro(
          "states", [](const Lens& self) { return nb::tuple(nb::cast(self.states.names)); },
          "Names of its zoom and focus positions.")
      .def(
          "in_state",
          [](const Lens& self, const std::variant<double, std::string>& state) {
            const LensReadOptions options{.glasses = glasses_of(self)};
            return std::visit(
                [&](const auto& which) { return std::make_shared<Lens>(in_state(self, which, options)); },
                state);
          },
          nb::arg("state"),
          "A copy set to a state, by name or by number from 0 on; between two numbers, in proportion.")
      .def(
          "reversed", [](const Lens& self) { return std::make_shared<Lens>(reversed_lens(self)); },
          "A copy turned round, its sensor in the paraxial image.")
      .def("scaled", scaled, nb::arg("factor").none() = nb::none(), nb::kw_only(),
           nb::arg("efl_mm").none() = nb::none(),
           "A copy with every length multiplied by `factor`, or so that its focal length is `efl_mm`; "
           "f-number "
           "and angles stay.")
      .def("copy", [](const Lens& self) { return std::make_shared<Lens>(self); })
      .def("__copy__", [](const Lens& self) { return std::make_shared<Lens>(self); })
      .def(
          "__deepcopy__", [](const Lens& self, const nb::dict&) { return std::make_shared<Lens>(self); },
          nb::arg("memo"))
      .def(
          "save", [](const Lens& self, const std::string& path) { warn(write_lens(self, path)); },
          nb::arg("path"),
          "Writes .json, .iset.json, .dat, .zmx or .seq, whole or not at all. A warning tells what a format "
          "leaves out.")
      .def(
          "transfer",
          [](const Lens& self, double tolerance_mm, std::optional<int> degree,
             std::optional<double> film_radius_mm, const Numbers& wavelengths_nm) {
            TransferFitRequest request;
            request.tolerance_mm = tolerance_mm;
            request.degree = degree;
            request.film_radius_mm = film_radius_mm;
            request.wavelengths_nm = wavelengths_nm;
            return std::make_shared<Lens>(fit_transfer(self, request).lens);
          },
          nb::kw_only(), nb::arg("tolerance_mm") = TransferFitRequest().tolerance_mm,
          nb::arg("degree").none() = nb::none(), nb::arg("film_radius_mm").none() = nb::none(),
          nb::arg("wavelengths_nm") = Numbers(),
          "What the lens does to rays, in place of its surfaces: a Lens of two planes. `tolerance_mm`: what "
          "rays "
          "held out may be off by in front, and in direction by this over the focal length. Raises "
          "InputError "
          "where no degree up to 7 meets it.")
      .def_static(
          "from_rays",
          [](const std::string& path, double tolerance_mm, std::optional<int> degree,
             std::optional<double> film_radius_mm) {
            TransferFitRequest request;
            request.tolerance_mm = tolerance_mm;
            request.degree = degree;
            request.film_radius_mm = film_radius_mm;
            return std::make_shared<Lens>(fit_transfer(read_ray_table(path), request).lens);
          },
          nb::arg("path"), nb::kw_only(), nb::arg("tolerance_mm") = TransferFitRequest().tolerance_mm,
          nb::arg("degree").none() = nb::none(), nb::arg("film_radius_mm").none() = nb::none(),
          "The lens of a table of rays that another program traced (.csv, docs/RAY_TRANSFER.md), as "
          "`transfer` makes it.")
      .def(
          "to_json",
          [](const Lens& self) {
            self.validate();
            return lens_to_json(self);
          },
          "As native JSON text; every number survives.")
      .def_static(
          "from_json",
          [](const std::string& text) { return std::make_shared<Lens>(lens_from_json(text, "text")); },
          nb::arg("text"))
      .def("__repr__", repr)
      .def("__reduce__", [](const Lens& self) {
        self.validate();
        std::vector<Material> glasses;
        for (const Surface& surface : self.surfaces)
          if (std::holds_alternative<std::shared_ptr<const Glass>>(surface.material.kind()))
            glasses.push_back(surface.material);
        return nb::make_tuple(nb::module_::import_("petzval._states").attr("lens"),
                              nb::make_tuple(lens_to_json(self), glasses));
      });
  module.def("_lens_from_state", [](const std::string& text, const std::vector<Material>& glasses) {
    std::vector<Glass> own;
    for (const Material& each : glasses) {
      const Glass& glass = *std::get<std::shared_ptr<const Glass>>(each.kind());
      if (std::ranges::none_of(own, [&](const Glass& g) { return g.full_name() == glass.full_name(); }))
        own.push_back(glass);
    }
    return std::make_shared<Lens>(
        lens_from_json(text, "pickle", {.glasses = GlassCatalogue::bundled().with(std::move(own))}));
  });
}

}  // namespace petzval::python
