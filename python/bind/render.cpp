// SPDX-License-Identifier: BSD-3-Clause
// Three-dimensional scenes through a camera, and autofocus on them.
#include <fmt/format.h>

#include "call.h"
#include "camera.h"

namespace petzval::python {

namespace {

template <typename Number>
using Maybe = std::optional<Number>;
using Zones = std::vector<std::array<double, 4>>;

std::vector<FocusZone> zones_from(const Zones& zones) {
  std::vector<FocusZone> result;
  for (const auto& [left, right, top, bottom] : zones) result.push_back({left, right, top, bottom});
  return result;
}

RenderRequest request(const CameraInPython& camera, const std::string& scene, Maybe<std::pair<int, int>> size,
                      const Numbers& wavelengths_nm, Maybe<int> samples_per_pixel, double noise,
                      bool first_surfaces, const Zones& zones, bool pinhole, Maybe<double> film_diagonal_mm,
                      Maybe<double> aperture_diameter_mm, bool diffraction, Maybe<int> max_depth,
                      double scene_unit_mm, Maybe<double> sky_cd_m2, bool absolute_spectra,
                      bool skip_unsupported, const std::string& checkpoint, const std::string& sampling,
                      Maybe<std::array<double, 2>> focus_pixel, Maybe<std::array<double, 3>> camera_at,
                      Maybe<std::array<double, 3>> look_at, Maybe<double> field_of_view_deg,
                      double light_scale) {
  RenderRequest r;
  r.focus_pixel = focus_pixel, r.camera_at = camera_at, r.look_at = look_at;
  r.field_of_view_deg = field_of_view_deg, r.light_scale = light_scale;
  r.scene = scene, r.camera = camera.value();
  if (size) r.columns = size->first, r.rows = size->second;
  r.wavelengths_nm = wavelengths_nm;
  r.samples_per_pixel = samples_per_pixel, r.noise = noise, r.first_surfaces = first_surfaces;
  r.autofocus.zones = zones_from(zones);
  r.pinhole = pinhole, r.film_diagonal_mm = film_diagonal_mm, r.aperture_diameter_mm = aperture_diameter_mm;
  r.diffraction = diffraction, r.max_depth = max_depth, r.scene_unit_mm = scene_unit_mm,
  r.sky_cd_m2 = sky_cd_m2;
  r.absolute_spectra = absolute_spectra, r.skip_unsupported = skip_unsupported, r.checkpoint = checkpoint;
  r.sampling = choice<RenderRequest::Sampling>("sampling", sampling,
                                               {{"exit-pupil", RenderRequest::Sampling::exit_pupil},
                                                {"rear-disk", RenderRequest::Sampling::rear_disk}});
  return r;
}

Rendering render(const CameraInPython& camera, const std::string& scene, Maybe<std::pair<int, int>> size,
                 const Numbers& wavelengths_nm, Maybe<int> samples_per_pixel, double noise,
                 bool first_surfaces, const Zones& zones, bool pinhole, Maybe<double> film_diagonal_mm,
                 Maybe<double> aperture_diameter_mm, bool diffraction, Maybe<int> max_depth,
                 double scene_unit_mm, Maybe<double> sky_cd_m2, bool absolute_spectra, bool skip_unsupported,
                 const std::string& checkpoint, const std::string& sampling,
                 Maybe<std::array<double, 2>> focus_pixel, Maybe<std::array<double, 3>> camera_at,
                 Maybe<std::array<double, 3>> look_at, Maybe<double> field_of_view_deg, double light_scale,
                 Maybe<std::array<double, 3>> camera_move, Maybe<std::array<double, 3>> look_move,
                 double rolling_shutter, Maybe<std::array<int, 4>> region,
                 Maybe<std::array<int, 2>> sample_range, int threads, std::uint64_t seed,
                 const nb::object& progress) {
  RenderRequest asked =
      request(camera, scene, size, wavelengths_nm, samples_per_pixel, noise, first_surfaces, zones, pinhole,
              film_diagonal_mm, aperture_diameter_mm, diffraction, max_depth, scene_unit_mm, sky_cd_m2,
              absolute_spectra, skip_unsupported, checkpoint, sampling, focus_pixel, camera_at, look_at,
              field_of_view_deg, light_scale);
  asked.camera_move = camera_move, asked.look_move = look_move, asked.rolling_shutter = rolling_shutter;
  asked.region = region, asked.sample_range = sample_range;
  Call call({threads, seed, progress});
  return call([&](const Context& context) { return render_scene(asked, context); });
}

FocusRun focus_on(const CameraInPython& camera, const std::string& scene, Maybe<std::pair<int, int>> size,
                  const Zones& zones, const std::string& measure, const std::string& search,
                  int samples_per_pixel, Maybe<int> most_evaluations, Maybe<double> from_mm,
                  Maybe<double> to_mm, Maybe<double> film_diagonal_mm, int threads, std::uint64_t seed,
                  const nb::object& progress) {
  RenderRequest r;
  r.scene = scene, r.camera = camera.value();
  if (size) r.columns = size->first, r.rows = size->second;
  r.film_diagonal_mm = film_diagonal_mm;
  AutofocusOptions& options = r.autofocus;
  options.zones = zones_from(zones);
  options.measure.measure = focus_measure_of(measure);
  options.search = autofocus_search_of(search);
  options.samples_per_pixel = samples_per_pixel, options.most_evaluations = most_evaluations;
  options.from_mm = from_mm, options.to_mm = to_mm;
  Call call({threads, seed, progress});
  return call([&](const Context& context) { return autofocus(r, context); });
}

/// A view of one of a rendering's planes, or None where it was not asked for.
template <std::vector<float> render::FirstSurfaces::*member>
nb::object first_surface(nb::handle self, std::size_t last) {
  auto& r = nb::cast<Rendering&>(self);
  if (!r.first_surfaces) return nb::none();
  std::vector<float>& values = (*r.first_surfaces).*member;
  const auto rows = static_cast<std::size_t>(r.irradiance.rows()),
             columns = static_cast<std::size_t>(r.irradiance.columns());
  const std::vector<std::size_t> shape =
      last > 0 ? std::vector{rows, columns, last} : std::vector{rows, columns};
  return nb::cast(Array<float>(values.data(), shape.size(), shape.data(), self));
}

}  // namespace

void bind_render(nb::class_<CameraInPython>& camera, nb::module_& module) {
  nb::class_<Rendering>(module, "Rendering", "What comes of rendering.")
      .def_prop_ro(
          "light", [](Rendering& r) -> SpectralImage& { return r.irradiance; },
          nb::rv_policy::reference_internal, "The irradiance on the sensor.")
      .def_prop_ro(
          "depth", [](nb::handle self) { return first_surface<&render::FirstSurfaces::depth>(self, 0); },
          "Distance from the film along the axis [scene units], (row, column), infinity where nothing is "
          "met; None unless `first_surfaces`.")
      .def_prop_ro(
          "normals", [](nb::handle self) { return first_surface<&render::FirstSurfaces::normal>(self, 3); },
          "In world space, (row, column, 3).")
      .def_prop_ro(
          "albedo",
          [](nb::handle self) -> nb::object {
            auto& r = nb::cast<Rendering&>(self);
            if (!r.first_surfaces) return nb::none();
            const SpectralImage& light = r.irradiance;
            return nb::cast(bands_view(r.first_surfaces->albedo.data(), light.rows(), light.columns(),
                                       light.bands(), self));
          },
          "What the surfaces reflect of the light that falls on them, 0 to 1, (row, column, wavelength).")
      .def_prop_ro(
          "share", [](nb::handle self) { return first_surface<&render::FirstSurfaces::share>(self, 0); },
          "Of the rays that met a surface, (row, column).")
      .def_ro("rays", &Rendering::rays)
      .def_ro("passed", &Rendering::passed, "Rays that got through the lens.")
      .def_ro("samples_per_pixel", &Rendering::samples_per_pixel)
      .def_ro("noise", &Rendering::noise, "Estimate, if it was asked for.")
      .def("__repr__", [](const Rendering& r) {
        return fmt::format("<Rendering {} x {}, {} bands, {} samples a pixel>", r.irradiance.columns(),
                           r.irradiance.rows(), r.irradiance.bands(), r.samples_per_pixel);
      });
  nb::class_<FocusRun>(module, "FocusRun", "A search for focus, and what it took.")
      .def_prop_ro(
          "film_distance_mm", [](const FocusRun& f) { return f.result.film_distance_mm; },
          "From the last vertex.")
      .def_prop_ro("measure", [](const FocusRun& f) { return f.result.measure; })
      .def_prop_ro(
          "at_the_end", [](const FocusRun& f) { return f.result.at_the_end; },
          "The sharpest place may lie beyond the range.")
      .def_prop_ro(
          "evaluations",
          [](const FocusRun& f) {
            std::vector<std::tuple<double, double, std::string>> all;
            for (const FocusEvaluation& e : f.result.evaluations)
              all.emplace_back(e.film_distance_mm, e.measure, e.stage);
            return all;
          },
          "(film distance [mm], measure, stage) in the order in which they were made.")
      .def_ro("distance_m", &FocusRun::distance_m, "From the film to what is sharp.")
      .def_ro("depth_mm", &FocusRun::depth_mm, "Depth of focus.")
      .def_ro("camera_rays", &FocusRun::camera_rays)
      .def("__repr__", [](const FocusRun& f) {
        return fmt::format("<FocusRun: film at {:.6g} mm after {} pictures>", f.result.film_distance_mm,
                           f.result.evaluations.size());
      });
  camera.def(
      "render", render, nb::arg("scene"), nb::kw_only(), nb::arg("size").none() = nb::none(),
      nb::arg("wavelengths_nm") = Numbers(), nb::arg("samples_per_pixel").none() = nb::none(),
      nb::arg("noise") = 0.0, nb::arg("first_surfaces") = false, nb::arg("zones") = Zones(),
      nb::arg("pinhole") = false, nb::arg("film_diagonal_mm").none() = nb::none(),
      nb::arg("aperture_diameter_mm").none() = nb::none(), nb::arg("diffraction") = false,
      nb::arg("max_depth").none() = nb::none(), nb::arg("scene_unit_mm") = 1000.0,
      nb::arg("sky_cd_m2").none() = nb::none(), nb::arg("absolute_spectra") = false,
      nb::arg("skip_unsupported") = false, nb::arg("checkpoint") = "", nb::arg("sampling") = "exit-pupil",
      nb::arg("focus_pixel").none() = nb::none(), nb::arg("camera_at").none() = nb::none(),
      nb::arg("look_at").none() = nb::none(), nb::arg("field_of_view_deg").none() = nb::none(),
      nb::arg("light_scale") = 1.0, nb::arg("camera_move").none() = nb::none(),
      nb::arg("look_move").none() = nb::none(), nb::arg("rolling_shutter") = 0.0,
      nb::arg("region").none() = nb::none(), nb::arg("sample_range").none() = nb::none(),
      nb::arg("threads") = 0, nb::arg("seed") = 1, nb::arg("progress").none() = nb::none(),
      "The light of a three-dimensional scene (pbrt-v4 text, .gltf, .glb or a bundled name) on the "
      "sensor, path-traced through every "
      "surface of the lens. `size`: (columns, rows). `noise` > 0: ends when that RMS error over mean "
      "light is reached. `zones`: "
      "(left, right, top, bottom) in fractions of the picture, for focus \"auto\". `focus_pixel`: (column, "
      "row) of what is to be sharp. `camera_at`, `look_at`: (x, y, z) [scene units]; "
      "`field_of_view_deg`: across the picture, without a lens. `camera_move`, `look_move`: how the camera "
      "and what is in the middle of its picture move while the shutter is open [scene units]; "
      "`rolling_shutter`: share of that time by which the last row begins after the first. `region` (column, "
      "row, columns, rows) and `sample_range` (first, end): a piece for `checkpoint`, which "
      "merge_renderings() puts together with others. Raises InputError; Cancelled.");
  module.def(
      "merge_renderings",
      [](const std::vector<std::string>& pieces, const std::string& checkpoint, const nb::object& progress) {
        Call call({0, 1, progress});
        call([&](const Context& context) { merge_renderings(pieces, checkpoint, context); });
      },
      nb::arg("pieces"), nb::arg("checkpoint"), nb::kw_only(), nb::arg("progress").none() = nb::none(),
      "Puts the pieces of a picture together, the checkpoints of Camera.render() with `region` or "
      "`sample_range`, in any order: `checkpoint` becomes what one process would have left, the same bytes. "
      "Raises InputError; Cancelled.");
  module.def(
      "list_unsupported",
      [](const std::string& scene) {
        RenderRequest r;
        r.scene = scene;
        std::vector<std::pair<std::string, std::string>> all;
        for (const UnsupportedFeature& each : unsupported_features(r))
          all.emplace_back(each.place, each.what);
        return all;
      },
      nb::arg("scene"), "[(place, what)] of what a three-dimensional scene has and Petzval has not.");
  camera.def(
      "autofocus", focus_on, nb::arg("scene"), nb::kw_only(), nb::arg("size").none() = nb::none(),
      nb::arg("zones") = Zones(), nb::arg("focus_measure") = "gradient", nb::arg("focus_search") = "brent",
      nb::arg("samples_per_pixel") = 16, nb::arg("most_evaluations") = nb::none(),
      nb::arg("from_mm").none() = nb::none(), nb::arg("to_mm").none() = nb::none(),
      nb::arg("film_diagonal_mm").none() = nb::none(), nb::arg("threads") = 0, nb::arg("seed") = 1,
      nb::arg("progress").none() = nb::none(),
      "The film distance at which the zones of a three-dimensional scene are sharpest, as a FocusRun.");
}

}  // namespace petzval::python
