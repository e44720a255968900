// SPDX-License-Identifier: BSD-3-Clause
#include "scene.h"

#include <fmt/format.h>
#include <petzval/colour/illuminants.h>
#include <petzval/scene/illuminant_swap.h>
#include <petzval/scene/spectral_cube.h>

#include <utility>

#include "call.h"
#include "constructor.h"

namespace petzval::python {

namespace {

DepthFrom depth_from(const std::string& word) {
  return choice<DepthFrom>(
      "depth_from", word,
      {{"sensor", DepthFrom::sensor}, {"pupil", DepthFrom::pupil}, {"range", DepthFrom::range}});
}

PhotographEncoding encoding_of(const std::string& word) {
  return choice<PhotographEncoding>("encoding", word,
                                    {{"auto", PhotographEncoding::by_file},
                                     {"srgb", PhotographEncoding::srgb},
                                     {"linear", PhotographEncoding::linear}});
}

SceneRequest request(const std::string& name, Maybe<int> columns, Maybe<int> rows,
                     const Numbers& wavelengths_nm, Maybe<double> horizontal_angle_deg,
                     Maybe<double> distance_m, const std::string& illuminant,
                     Maybe<double> mean_luminance_cd_m2, const Maybe<std::string>& encoding,
                     Maybe<std::pair<double, double>> panorama_yaw_pitch_deg, const std::string& depth,
                     Maybe<double> depth_scale, const Maybe<std::string>& depth_from_word,
                     const Maybe<std::string>& quantity, const std::string& radiance_unit,
                     Maybe<double> scale, const Numbers& file_bands_nm, bool negative_is_zero,
                     Maybe<double> temperature_k, Maybe<double> emissivity, Maybe<double> background_k,
                     Maybe<double> illuminance_lx, Maybe<double> irradiance_w_m2, Maybe<double> band_width_nm,
                     Maybe<double> width_m, Maybe<double> tilt_deg) {
  SceneRequest scene{name, {}};
  SceneOptions& o = scene.options;
  o.columns = columns, o.rows = rows;
  o.wavelengths_nm = wavelengths_nm;
  o.horizontal_angle_deg = horizontal_angle_deg, o.distance_m = distance_m;
  o.width_m = width_m, o.tilt_deg = tilt_deg;
  o.illuminant = illuminant;
  o.mean_luminance_cd_m2 = mean_luminance_cd_m2;
  o.illuminance_lx = illuminance_lx, o.irradiance_w_m2 = irradiance_w_m2, o.band_width_nm = band_width_nm;
  if (encoding) o.encoding = encoding_of(*encoding);
  if (panorama_yaw_pitch_deg) o.panorama = {panorama_yaw_pitch_deg->first, panorama_yaw_pitch_deg->second};
  o.depth = depth, o.depth_scale = depth_scale;
  if (depth_from_word) o.depth_from = depth_from(*depth_from_word);
  if (quantity) o.quantity = parse_scene_quantity(*quantity);
  o.radiance_unit = radiance_unit, o.scale = scale;
  o.file_bands_nm = file_bands_nm, o.negative_is_zero = negative_is_zero;
  o.thermal.temperature_k = temperature_k;
  if (emissivity) o.thermal.emissivity = *emissivity;
  if (background_k) o.thermal.background_k = *background_k;
  return scene;
}

/// A light by name, or wavelengths and values.
Spectrum spectrum_from(const nb::object& light) {
  if (nb::isinstance<nb::str>(light)) return illuminant(nb::cast<std::string>(light));
  const auto [nm, values] = nb::cast<std::pair<Numbers, Numbers>>(light);
  return {nm, values};
}

void warn_of(const Scene& scene) {
  Call call;
  call([&](const Context& context) {
    for (const std::string& note : scene.notes) send_note(context, note);
    return true;
  });
}

Scene of_arrays(const FloatsIn& values, const Numbers& wavelengths_nm, double horizontal_angle_deg,
                Maybe<double> distance_m, const nb::object& light, Maybe<double> mean_luminance_cd_m2,
                const Maybe<nb::ndarray<const float, nb::ndim<2>, nb::c_contig, nb::device::cpu>>& depth_m,
                const std::string& depth_from_word, SceneQuantity quantity) {
  const char* name = quantity == SceneQuantity::reflectance ? "reflectance" : "radiance";
  SpectralCube cube;
  cube.values = LargeFloats(bands_of(name, values, wavelengths_nm));
  cube.rows = static_cast<int>(values.shape(0)), cube.columns = static_cast<int>(values.shape(1)),
  cube.bands = static_cast<int>(values.shape(2));
  cube.wavelengths_nm = wavelengths_nm;
  cube.quantity = quantity;
  cube.horizontal_angle_deg = horizontal_angle_deg, cube.distance_m = distance_m;
  cube.name = "array";
  if (depth_m) {
    if (depth_m->shape(0) != values.shape(0) || depth_m->shape(1) != values.shape(1))
      throw InputError(
          fmt::format("`depth_m` of {} x {}; as many rows and columns as the scene would be right",
                      depth_m->shape(0), depth_m->shape(1)));
    cube.depth_m.assign(depth_m->data(), depth_m->data() + depth_m->size());
    cube.depth_from = depth_from(depth_from_word);
  }
  CubeOptions options;
  if (!light.is_none()) {
    if (quantity == SceneQuantity::radiance)
      cube.illuminant = spectrum_from(light);
    else
      options.illuminant = spectrum_from(light);
  }
  options.level_follows = mean_luminance_cd_m2.has_value();
  Scene scene = scene_of(std::move(cube), options);
  if (mean_luminance_cd_m2) scene.set_mean_luminance_cd_m2(*mean_luminance_cd_m2);
  warn_of(scene);
  return scene;
}

Scene of_radiance(const FloatsIn& radiance, const Numbers& wavelengths_nm, double angle,
                  Maybe<double> distance_m, const nb::object& light,
                  const Maybe<nb::ndarray<const float, nb::ndim<2>, nb::c_contig, nb::device::cpu>>& depth_m,
                  const std::string& from) {
  return of_arrays(radiance, wavelengths_nm, angle, distance_m, light, {}, depth_m, from,
                   SceneQuantity::radiance);
}

Scene of_reflectance(
    const FloatsIn& reflectance, const Numbers& wavelengths_nm, const nb::object& light, double luminance,
    double angle, Maybe<double> distance_m,
    const Maybe<nb::ndarray<const float, nb::ndim<2>, nb::c_contig, nb::device::cpu>>& depth_m,
    const std::string& from) {
  return of_arrays(reflectance, wavelengths_nm, angle, distance_m, light, luminance, depth_m, from,
                   SceneQuantity::reflectance);
}

/// To be written, unless the samples stand beside figures, which would not follow.
nb::object radiance_view(nb::handle self) {
  auto& scene = nb::cast<Scene&>(self);
  const bool drawn = scene.drawing() != nullptr;
  const float* values = scene.bands() > 0 ? std::as_const(scene).band(0).data() : nullptr;
  const nb::object view =
      nb::cast(bands_view(const_cast<float*>(values), scene.rows(), scene.columns(), scene.bands(), self));
  if (drawn) view.attr("flags").attr("writeable") = false;
  return view;
}

nb::object depth_view(nb::handle self) {
  auto& scene = nb::cast<Scene&>(self);
  if (scene.depth_m.empty()) return nb::none();
  const std::size_t shape[] = {static_cast<std::size_t>(scene.rows()),
                               static_cast<std::size_t>(scene.columns())};
  return nb::cast(Array<float>(scene.depth_m.data(), 2, shape, self));
}

void bind_request(nb::module_& module) {
  nb::class_<SceneRequest>(
      module, "SceneRequest", nb::type_slots(explained_constructor),
      "A scene to be read: a file, a photograph, or a chart by name. What is left open follows from the "
      "camera: a chart or photograph without an angle fills the frame.")
      .def(nb::new_(&request), nb::arg("name"), nb::kw_only(), nb::arg("columns").none() = nb::none(),
           nb::arg("rows").none() = nb::none(), nb::arg("wavelengths_nm") = Numbers(),
           nb::arg("horizontal_angle_deg").none() = nb::none(), nb::arg("distance_m").none() = nb::none(),
           nb::arg("illuminant") = "", nb::arg("mean_luminance_cd_m2").none() = nb::none(),
           nb::arg("encoding").none() = nb::none(), nb::arg("panorama_yaw_pitch_deg").none() = nb::none(),
           nb::arg("depth") = "", nb::arg("depth_scale").none() = nb::none(),
           nb::arg("depth_from").none() = nb::none(), nb::arg("quantity").none() = nb::none(),
           nb::arg("radiance_unit") = "", nb::arg("scale").none() = nb::none(),
           nb::arg("file_bands_nm") = Numbers(), nb::arg("negative_is_zero") = false,
           nb::arg("temperature_k").none() = nb::none(), nb::arg("emissivity").none() = nb::none(),
           nb::arg("background_k").none() = nb::none(), nb::arg("illuminance_lx").none() = nb::none(),
           nb::arg("irradiance_w_m2").none() = nb::none(), nb::arg("band_width_nm").none() = nb::none(),
           nb::arg("width_m").none() = nb::none(), nb::arg("tilt_deg").none() = nb::none(),
           "docs/SCENES.md says what each keyword does; the program's options of the same names do the same.")
      .def_ro("name", &SceneRequest::name)
      .def(
          "read",
          [](const SceneRequest& self) {
            Call call;
            Scene scene = call([&](const Context&) { return read_scene(self.name, self.options); });
            warn_of(scene);
            return scene;
          },
          "The Scene itself, 40 degrees wide where nothing says how wide it is.")
      .def("__repr__",
           [](const SceneRequest& self) { return fmt::format("<SceneRequest '{}'>", self.name); });
}

}  // namespace

SceneChoice scene_from(const nb::object& scene) {
  if (nb::isinstance<nb::str>(scene)) return SceneRequest{nb::cast<std::string>(scene), {}};
  if (nb::isinstance<Scene>(scene)) return nb::cast<Scene>(scene);
  if (nb::hasattr(scene, "__fspath__")) return SceneRequest{nb::cast<std::string>(nb::str(scene)), {}};
  if (nb::isinstance<SceneRequest>(scene)) return nb::cast<SceneRequest>(scene);
  throw nb::type_error(
      "`scene`: a name, a path, a SceneRequest or a Scene would be right; Scene(radiance, wavelengths_nm) "
      "and "
      "Scene.from_reflectance(reflectance, wavelengths_nm) make one of an array");
}

void bind_scene(nb::module_& module) {
  bind_request(module);
  nb::class_<Scene>(module, "Scene", nb::type_slots(explained_constructor),
                    "Spectral radiance [W/(m2 sr nm)] on a plane square to the axis, upright, row 0 on top.")
      .def(nb::new_(&of_radiance), nb::arg("radiance"), nb::arg("wavelengths_nm"), nb::kw_only(),
           nb::arg("horizontal_angle_deg") = 40.0, nb::arg("distance_m").none() = nb::none(),
           nb::arg("illuminant").none() = nb::none(), nb::arg("depth_m").none() = nb::none(),
           nb::arg("depth_from") = "sensor",
           "Of an array (row, column, wavelength) of float32 radiance. `distance_m` None: at infinity. "
           "`illuminant`: the "
           "light of the scene, where known, by name or as (wavelengths, values). `depth_m`: (row, column), "
           "from the "
           "\"sensor\", the \"pupil\" or as \"range\". The values are copied.")
      .def_static("from_reflectance", of_reflectance, nb::arg("reflectance"), nb::arg("wavelengths_nm"),
                  nb::kw_only(), nb::arg("illuminant") = "D65", nb::arg("mean_luminance_cd_m2") = 100.0,
                  nb::arg("horizontal_angle_deg") = 40.0, nb::arg("distance_m").none() = nb::none(),
                  nb::arg("depth_m").none() = nb::none(), nb::arg("depth_from") = "sensor",
                  "Of reflectances (row, column, wavelength), 0 to 1, under a light.")
      .def_prop_ro(
          "radiance", radiance_view,
          "A view (row, column, wavelength) of float32 [W/m2/sr/nm], without a copy. Of a chart it is "
          "read-only: its figures are drawn anew on every sensor; Scene(radiance.copy(), ...) makes a "
          "scene of the samples.")
      .def_prop_ro("depth_m", depth_view, "A view (row, column) of the depths [m], or None.")
      .def_prop_ro("wavelengths_nm", [](const Scene& s) { return tuple_of(s.wavelengths_nm()); })
      .def_prop_ro("columns", &Scene::columns)
      .def_prop_ro("rows", &Scene::rows)
      .def_prop_rw("horizontal_angle_deg", &Scene::horizontal_angle_deg, &Scene::set_horizontal_angle_deg)
      .def_prop_rw("distance_m", &Scene::distance_m, &Scene::set_distance_m,
                   nb::for_setter(nb::arg("value").none()), "From the sensor plane [m]; None: infinity.")
      .def_prop_rw("mean_luminance_cd_m2", &Scene::mean_luminance_cd_m2, &Scene::set_mean_luminance_cd_m2)
      .def_rw("name", &Scene::name)
      .def(
          "swap_illuminant",
          [](Scene& s, const nb::object& light) { swap_illuminant(s, spectrum_from(light)); },
          nb::arg("illuminant"), "Puts a scene whose light is known under another.")
      .def(
          "to_xarray", [](nb::handle self) { return call_python("petzval._xarray", "scene", self); },
          "As xarray.DataArray (y, x, wavelength), tangents of the object angle as coordinates.")
      .def(
          "__array__",
          [](nb::handle self, const nb::object& dtype, const nb::object& copy) {
            return call_python("petzval._arrays", "array", radiance_view(self), dtype, copy);
          },
          nb::arg("dtype").none() = nb::none(), nb::arg("copy").none() = nb::none())
      .def("__repr__", [](const Scene& s) {
        return fmt::format("<Scene '{}': {} bands, {} x {} samples, {:g} degrees wide>", s.name, s.bands(),
                           s.columns(), s.rows(), s.horizontal_angle_deg());
      });
  module.def(
      "chart_names",
      [] {
        std::vector<std::string> names;
        for (const BuiltinScene& each : builtin_scenes()) names.push_back(each.name);
        return names;
      },
      "Names of the built-in flat scenes.");
}

}  // namespace petzval::python
