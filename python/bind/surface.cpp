// SPDX-License-Identifier: BSD-3-Clause
#include "surface.h"

#include <fmt/ranges.h>
#include <petzval/lens/formats/native.h>

#include <charconv>
#include <cmath>
#include <limits>

#include "constructor.h"
#include "glass.h"
#include "lens_parts.h"

namespace petzval::python {

namespace {

std::size_t digits(double value) {
  char text[32];
  return static_cast<std::size_t>(std::to_chars(text, text + sizeof text, value).ptr - text);
}

/// The shortest number whose reciprocal the curvature is.
double radius_of(double curvature) {
  if (curvature == 0) return std::numeric_limits<double>::infinity();
  const double nearest = 1 / curvature;
  double best = nearest;
  for (const double each : {std::nextafter(nearest, -HUGE_VAL), std::nextafter(nearest, HUGE_VAL)})
    if (1 / each == curvature && (1 / best != curvature || digits(each) < digits(best))) best = each;
  return best;
}

double curvature_of(const std::optional<double>& radius_mm) {
  if (!radius_mm || std::isinf(*radius_mm)) return 0;
  if (!(*radius_mm != 0) || std::isnan(*radius_mm))
    throw InputError(fmt::format(
        "`radius_mm` {}; a length other than 0, or None for a flat surface, would be right", *radius_mm));
  return 1 / *radius_mm;
}

nb::object shape_of(const Surface& surface) {
  if (!surface.shape) return nb::none();
  nb::dict dict;
  dict["kind"] = surface.shape->kind;
  for (const auto& [name, numbers] : surface.shape->parameters)
    dict[name.c_str()] = numbers.size() == 1 ? nb::cast(numbers[0]) : nb::object(tuple_of(numbers));
  return read_only(dict);
}

void set_shape(Surface& surface, const nb::object& shape) {
  surface.shape.reset();
  if (shape.is_none()) return;
  AddedShape added;
  for (const auto& [key, value] : dict_of(shape)) {
    const auto name = nb::cast<std::string>(key);
    if (name == "kind")
      added.kind = nb::cast<std::string>(value);
    else
      added.parameters[name] =
          nb::isinstance<nb::sequence>(value) ? nb::cast<Numbers>(value) : Numbers{nb::cast<double>(value)};
  }
  surface.shape = std::move(added);
}

/// What the native file has of a surface, as Python's values; None where there is nothing.
nb::object native_value(const std::string& json) {
  return json.empty() ? nb::object(nb::none()) : call_python("json", "loads", json);
}

nb::object coating_of(const Surface& surface) {
  return native_value(surface.coating ? coating_text(*surface.coating) : "");
}

nb::object scatter_of(const Surface& surface) {
  return native_value(surface.scatter ? scatter_text(*surface.scatter) : "");
}

nb::object grating_of(const Surface& surface) {
  if (!surface.grating) return nb::none();
  nb::dict dict;
  dict["lines_per_mm"] = surface.grating->lines_per_mm;
  dict["order"] = surface.grating->order;
  dict["rotation_deg"] = surface.grating->rotation_deg;
  return read_only(dict);
}

nb::object ideal_lens_of(const Surface& surface) {
  if (!surface.ideal_lens) return nb::none();
  nb::dict dict;
  dict["focal_length_mm"] = surface.ideal_lens->focal_length_mm;
  return read_only(dict);
}

/// The numbers of a dict, by name; the first `required` of them must be there.
std::vector<double> numbers_of(const nb::dict& dict, const char* what, std::vector<const char*> names,
                               std::size_t required) {
  std::vector<double> numbers(names.size(), 0.0);
  std::size_t found = 0, needed = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!dict.contains(names[i])) continue;
    numbers[i] = nb::cast<double>(dict[names[i]]);
    ++found, needed += i < required;
  }
  if (found != dict.size() || needed != required)
    throw InputError(fmt::format("`{}` takes {}", what, fmt::join(names, ", ")));
  return numbers;
}

void set_grating(Surface& surface, const nb::object& grating) {
  surface.grating.reset();
  if (grating.is_none()) return;
  const auto numbers = numbers_of(dict_of(grating), "grating", {"lines_per_mm", "order", "rotation_deg"}, 2);
  surface.grating = Grating{numbers[0], numbers[1], numbers[2]};
}

void set_ideal_lens(Surface& surface, const nb::object& ideal_lens) {
  surface.ideal_lens.reset();
  if (ideal_lens.is_none()) return;
  surface.ideal_lens = IdealLens{numbers_of(dict_of(ideal_lens), "ideal_lens", {"focal_length_mm"}, 1)[0]};
}

void set_coating(Surface& surface, const nb::object& coating) {
  surface.coating.reset();
  if (coating.is_none()) return;
  const JsonDocument document(nb::cast<std::string>(call_python("json", "dumps", coating)), "coating");
  surface.coating = read_surface_coating(JsonEntry(document));
}

void set_scatter(Surface& surface, const nb::object& scatter) {
  surface.scatter.reset();
  if (scatter.is_none()) return;
  const JsonDocument document(nb::cast<std::string>(call_python("json", "dumps", scatter)), "scatter");
  surface.scatter = read_scatter(JsonEntry(document));
}

std::string repr(SurfaceView& view) {
  const Surface& s = view.get();
  std::string text =
      fmt::format("Surface(radius_mm={}, thickness_mm={}",
                  s.curvature_per_mm == 0 ? "None" : number_repr(radius_of(s.curvature_per_mm)),
                  number_repr(s.thickness_mm));
  if (!s.material.is_air()) text += fmt::format(", glass='{}'", s.material.description());
  if (s.semi_diameter_mm) text += ", semi_diameter_mm=" + number_repr(*s.semi_diameter_mm);
  if (s.mirror) text += ", mirror=True";
  if (s.stop) text += ", stop=True";
  if (s.conic != 0) text += ", conic=" + number_repr(s.conic);
  if (!s.asphere.empty()) text += ", asphere=" + nb::cast<std::string>(nb::repr(nb::cast(s.asphere)));
  if (!s.apertures.empty()) text += fmt::format(", apertures=<{} figures>", s.apertures.size());
  if (!s.pose.is_none()) text += ", pose=" + nb::cast<std::string>(nb::repr(dict_of(pose_to(s.pose))));
  if (s.grating) text += ", grating=" + nb::cast<std::string>(nb::repr(dict_of(grating_of(s))));
  if (s.ideal_lens) text += ", ideal_lens=" + nb::cast<std::string>(nb::repr(dict_of(ideal_lens_of(s))));
  if (s.shape) text += ", shape=" + nb::cast<std::string>(nb::repr(dict_of(shape_of(s))));
  return text + ")";
}

SurfaceView surface(Maybe<double> radius_mm, double thickness_mm, const nb::object& glass,
                    Maybe<double> semi_diameter_mm, bool stop, double conic,
                    const std::map<int, double>& asphere, const nb::object& shape,
                    std::pair<int, double> blades, bool mirror, const nb::iterable& apertures,
                    const nb::dict& pose) {
  Surface s;
  s.curvature_per_mm = curvature_of(radius_mm);
  s.thickness_mm = thickness_mm;
  s.material = material_from(glass);
  s.semi_diameter_mm = semi_diameter_mm;
  s.stop = stop;
  s.conic = conic;
  s.asphere = asphere;
  s.blades = {blades.first, blades.second};
  s.mirror = mirror;
  s.apertures = apertures_from(apertures);
  s.pose = pose_from(pose);
  set_shape(s, shape);
  return SurfaceView(std::move(s));
}

/// What pickles.
nb::object plain(const nb::object& dict) {
  return dict.is_none() ? dict : nb::object(dict_of(dict));
}

nb::tuple state_of(SurfaceView& view) {
  const Surface& s = view.get();
  if (s.transfer)
    throw InputError(
        "a surface of a ray-transfer lens is not pickled by itself; the whole lens would be right");
  const nb::object shape = shape_of(s);
  nb::list apertures;
  for (const nb::handle each : apertures_to(s.apertures)) apertures.append(dict_of(nb::borrow(each)));
  return nb::make_tuple(s.curvature_per_mm, s.thickness_mm, s.material, s.stop,
                        std::pair(s.blades.count, s.blades.rotation_deg), s.semi_diameter_mm, s.conic,
                        s.asphere, shape.is_none() ? shape : nb::object(dict_of(shape)), s.mirror, apertures,
                        dict_of(pose_to(s.pose)), coating_of(s), scatter_of(s), plain(grating_of(s)),
                        plain(ideal_lens_of(s)));
}

SurfaceView of_state(double curvature_per_mm, double thickness_mm, const Material& glass, bool stop,
                     std::pair<int, double> blades, Maybe<double> semi_diameter_mm, double conic,
                     const std::map<int, double>& asphere, const nb::object& shape, bool mirror,
                     const nb::iterable& apertures, const nb::dict& pose, const nb::object& coating,
                     const nb::object& scatter, const nb::object& grating, const nb::object& ideal_lens) {
  Surface s;
  s.curvature_per_mm = curvature_per_mm, s.thickness_mm = thickness_mm;
  s.material = glass;
  s.stop = stop, s.mirror = mirror;
  s.blades = {blades.first, blades.second};
  s.semi_diameter_mm = semi_diameter_mm;
  s.conic = conic, s.asphere = asphere;
  set_shape(s, shape);
  s.apertures = apertures_from(apertures), s.pose = pose_from(pose);
  set_coating(s, coating), set_scatter(s, scatter);
  set_grating(s, grating), set_ideal_lens(s, ideal_lens);
  return SurfaceView(std::move(s));
}

void bind_surface_itself(nb::module_& module) {
  using View = SurfaceView;
  nb::class_<View>(
      module, "Surface", nb::type_slots(explained_constructor),
      "A surface and the gap behind it. One that was taken from `lens.surfaces` alters that lens.")
      .def(nb::new_(&surface), nb::arg("radius_mm").none() = nb::none(), nb::arg("thickness_mm") = 0.0,
           nb::arg("glass").none() = nb::none(), nb::kw_only(),
           nb::arg("semi_diameter_mm").none() = nb::none(), nb::arg("stop") = false, nb::arg("conic") = 0.0,
           nb::arg("asphere") = std::map<int, double>(), nb::arg("shape").none() = nb::none(),
           nb::arg("blades") = std::pair(0, 0.0), nb::arg("mirror") = false,
           nb::arg("apertures") = nb::tuple(), nb::arg("pose") = nb::dict(),
           "Lengths in mm; the properties of the same names say what each is.")
      .def_prop_rw(
          "radius_mm", [](View& v) { return radius_of(v.get().curvature_per_mm); },
          [](View& v, std::optional<double> r) { v.get().curvature_per_mm = curvature_of(r); },
          nb::for_setter(nb::arg("value").none()),
          "Above 0 when the centre of curvature lies behind the surface; inf (or None) is flat.")
      .def_prop_rw(
          "curvature_per_mm", [](View& v) { return v.get().curvature_per_mm; },
          [](View& v, double c) { v.get().curvature_per_mm = c; }, "1/radius [1/mm].")
      .def_prop_rw(
          "thickness_mm", [](View& v) { return v.get().thickness_mm; },
          [](View& v, double t) { v.get().thickness_mm = t; },
          "To the next vertex; of the last surface to the image.")
      .def_prop_rw(
          "glass", [](View& v) { return v.get().material; },
          [](View& v, const nb::object& g) { v.get().material = material_from(g); },
          nb::for_setter(nb::arg("value").none()),
          "Glass behind the surface; a name, a Glass, or None for air is taken.")
      .def_prop_rw(
          "semi_diameter_mm", [](View& v) { return v.get().semi_diameter_mm; },
          [](View& v, std::optional<double> d) { v.get().semi_diameter_mm = d; },
          nb::for_setter(nb::arg("value").none()), "Clear semi-aperture; None: unbounded.")
      .def_prop_rw(
          "stop", [](View& v) { return v.get().stop; }, [](View& v, bool stop) { v.get().stop = stop; })
      .def_prop_rw(
          "mirror", [](View& v) { return v.get().mirror; },
          [](View& v, bool mirror) { v.get().mirror = mirror; },
          "Throws the light back; the thickness behind it is negative while light runs towards −z.")
      .def_prop_rw(
          "conic", [](View& v) { return v.get().conic; }, [](View& v, double k) { v.get().conic = k; })
      .def_prop_rw(
          "asphere", [](View& v) { return read_only(nb::cast(v.get().asphere)); },
          [](View& v, const std::map<int, double>& a) { v.get().asphere = a; },
          "{power p of r: coefficient [mm^(1-p)]}; assign a whole dict.")
      .def_prop_rw(
          "shape", [](View& v) { return shape_of(v.get()); },
          [](View& v, const nb::object& shape) { set_shape(v.get(), shape); },
          nb::for_setter(nb::arg("value").none()),
          "{\"kind\": …, parameters} of a kind of surface beyond conics and powers, or None.")
      .def_prop_rw(
          "blades", [](View& v) { return std::pair(v.get().blades.count, v.get().blades.rotation_deg); },
          [](View& v, std::pair<int, double> b) {
            v.get().blades = {b.first, b.second};
          },
          "(count, rotation [degrees]) of the blades of the stop; (0, 0): round.")
      .def_prop_rw(
          "apertures", [](View& v) { return apertures_to(v.get().apertures); },
          [](View& v, const nb::iterable& apertures) { v.get().apertures = apertures_from(apertures); },
          "Figures that light must pass besides, as the native file has them: ({\"rectangle\": (8, 5)}, "
          "{\"ellipse\": (3, 3), \"obscures\": True}), half the widths along x and y [mm], with "
          "\"decentre_mm\" (x, y) and \"rotation_deg\"; assign a whole sequence.")
      .def_prop_rw(
          "pose", [](View& v) { return pose_to(v.get().pose); },
          [](View& v, const nb::object& pose) { v.get().pose = pose_from(dict_of(pose)); },
          "How far it stands off its place: any of decentre_x_mm, decentre_y_mm, shift_z_mm, tilt_x_deg, "
          "tilt_y_deg, tilt_z_deg; assign a whole dict.")
      .def_prop_rw(
          "coating", [](View& v) { return coating_of(v.get()); },
          [](View& v, const nb::object& coating) { set_coating(v.get(), coating); },
          nb::for_setter(nb::arg("value").none()),
          "As the native file has it: a bundled name, a reflectance, [(wavelength [nm], reflectance), …], a "
          "dict with \"layers\", or None for bare glass; assign a whole value.")
      .def_prop_rw(
          "grating", [](View& v) { return grating_of(v.get()); },
          [](View& v, const nb::object& grating) { set_grating(v.get(), grating); },
          nb::for_setter(nb::arg("value").none()),
          "Lines ruled on it, {\"lines_per_mm\": 600, \"order\": -1, \"rotation_deg\": 0}, or None; assign a "
          "whole dict.")
      .def_prop_rw(
          "ideal_lens", [](View& v) { return ideal_lens_of(v.get()); },
          [](View& v, const nb::object& ideal) { set_ideal_lens(v.get(), ideal); },
          nb::for_setter(nb::arg("value").none()),
          "The ideal lens that this plane is, {\"focal_length_mm\": 50}, or None; assign a whole dict.")
      .def_prop_rw(
          "scatter", [](View& v) { return scatter_of(v.get()); },
          [](View& v, const nb::object& scatter) { set_scatter(v.get(), scatter); },
          nb::for_setter(nb::arg("value").none()),
          "How it scatters, as the native file has it: {\"roughness_nm\": 2, \"dust_percent\": 0.05}, or "
          "None; "
          "assign a whole dict.")
      .def("__repr__", repr)
      .def("__reduce__", [](View& view) {
        return nb::make_tuple(nb::module_::import_("petzval._states").attr("surface"), state_of(view));
      });
  module.def("_surface_from_state", of_state, nb::arg(), nb::arg(), nb::arg(), nb::arg(), nb::arg(),
             nb::arg().none(), nb::arg(), nb::arg(), nb::arg().none(), nb::arg(), nb::arg(), nb::arg(),
             nb::arg().none(), nb::arg().none(), nb::arg().none() = nb::none(),
             nb::arg().none() = nb::none());
}

}  // namespace

std::vector<Surface> surfaces_from(const nb::iterable& surfaces) {
  std::vector<Surface> result;
  for (const nb::handle each : surfaces) result.push_back(nb::cast<SurfaceView&>(each).get());
  return result;
}

void bind_surface(nb::module_& module) {
  bind_surface_itself(module);
  nb::class_<SurfaceList>(module, "SurfaceList", "The surfaces of a lens, front to back, as a list.")
      .def("__len__", [](const SurfaceList& list) { return list.lens->surfaces.size(); })
      .def("__getitem__",
           [](const SurfaceList& list, std::ptrdiff_t i) { return SurfaceView(list.lens, list.place(i)); })
      .def("__setitem__",
           [](SurfaceList& list, std::ptrdiff_t i, SurfaceView& surface) {
             list.lens->surfaces[list.place(i)] = Surface(surface.get());
           })
      .def("__delitem__",
           [](SurfaceList& list, std::ptrdiff_t i) {
             list.lens->surfaces.erase(list.lens->surfaces.begin() +
                                       static_cast<std::ptrdiff_t>(list.place(i)));
           })
      .def(
          "append",
          [](SurfaceList& list, SurfaceView& surface) {
            list.lens->surfaces.push_back(Surface(surface.get()));
          },
          nb::arg("surface"))
      .def(
          "insert",
          [](SurfaceList& list, std::ptrdiff_t i, SurfaceView& surface) {
            const auto count = static_cast<std::ptrdiff_t>(list.lens->surfaces.size());
            if (i < 0) i += count;
            list.lens->surfaces.insert(list.lens->surfaces.begin() + std::clamp<std::ptrdiff_t>(i, 0, count),
                                       Surface(surface.get()));
          },
          nb::arg("index"), nb::arg("surface"))
      .def("__repr__", [](const SurfaceList& list) {
        std::string text = "[";
        for (std::size_t i = 0; i < list.lens->surfaces.size(); ++i) {
          SurfaceView view(list.lens, i);
          text += (i ? ",\n " : "") + repr(view);
        }
        return text + "]";
      });
}

}  // namespace petzval::python
