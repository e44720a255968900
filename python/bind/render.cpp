// SPDX-License-Identifier: BSD-3-Clause
// Three-dimensional scenes through a camera, and autofocus on them.
#include <fmt/format.h>
#include <petzval/simulate/render_estimate.h>
#include <petzval/simulate/render_frames.h>
#include <petzval/simulate/render_session.h>
#include <petzval/simulate/scene_segments.h>
#include <petzval/simulate/scene_truth.h>

#include "camera.h"
#include "keywords.h"

namespace petzval::python {

namespace {

using Zones = std::vector<std::array<double, 4>>;

std::vector<FocusZone> zones_from(const Zones& zones) {
  std::vector<FocusZone> result;
  for (const auto& [left, right, top, bottom] : zones) result.push_back({left, right, top, bottom});
  return result;
}

/// A rendering, and what was asked for beside it.
struct RenderingInPython : Rendering {
  explicit RenderingInPython(Rendering light) : Rendering(std::move(light)) {}
  Maybe<FlareLayers> flare = {};
  std::vector<std::int32_t> segments = {};  ///< [row][column][shape, instance, material]
  std::vector<float> flow = {};             ///< [row][column][right, down]
};

RenderRequest request_of(
    const CameraInPython& camera, const std::string& scene, Maybe<std::pair<int, int>> size,
    const Numbers& wavelengths_nm, Maybe<int> samples_per_pixel, double noise, bool first_surfaces,
    const Zones& zones, bool pinhole, Maybe<double> film_diagonal_mm, Maybe<double> aperture_diameter_mm,
    bool diffraction, Maybe<int> max_depth, double scene_unit_mm, Maybe<double> sky_cd_m2,
    bool absolute_spectra, bool skip_unsupported, const std::string& checkpoint, double checkpoint_seconds,
    const std::string& sampling, Maybe<std::array<double, 2>> focus_pixel, bool focus_as_in_scene,
    Maybe<std::array<double, 3>> camera_at, Maybe<std::array<double, 3>> look_at,
    Maybe<double> field_of_view_deg, double light_scale, Maybe<std::array<double, 3>> camera_move,
    Maybe<std::array<double, 3>> look_move, double rolling_shutter, const std::string& camera_origin,
    Maybe<double> near_distance, Maybe<double> far_distance, Maybe<std::array<int, 4>> region,
    Maybe<std::array<int, 2>> sample_range, const std::vector<std::string>& lights, double scene_time,
    bool light_groups, bool denoise_light) {
  RenderRequest r;
  for (const std::string& text : lights) r.light_changes.push_back(render::parse_light_change(text));
  r.scene = scene, r.camera = camera.value();
  if (size) r.columns = size->first, r.rows = size->second;
  r.wavelengths_nm = wavelengths_nm;
  r.samples_per_pixel = samples_per_pixel, r.noise = noise, r.first_surfaces = first_surfaces;
  r.autofocus.zones = zones_from(zones);
  r.pinhole = pinhole, r.film_diagonal_mm = film_diagonal_mm, r.aperture_diameter_mm = aperture_diameter_mm;
  r.diffraction = diffraction, r.max_depth = max_depth, r.scene_unit_mm = scene_unit_mm;
  r.sky_cd_m2 = sky_cd_m2, r.light_scale = light_scale;
  r.absolute_spectra = absolute_spectra, r.skip_unsupported = skip_unsupported;
  r.checkpoint = checkpoint, r.checkpoint_seconds = checkpoint_seconds;
  r.sampling = choice<RenderRequest::Sampling>("sampling", sampling,
                                               {{"exit-pupil", RenderRequest::Sampling::exit_pupil},
                                                {"rear-disk", RenderRequest::Sampling::rear_disk}});
  r.focus_pixel = focus_pixel, r.focus_as_in_scene = focus_as_in_scene;
  r.camera_at = camera_at, r.look_at = look_at, r.field_of_view_deg = field_of_view_deg;
  r.camera_move = camera_move, r.look_move = look_move, r.rolling_shutter = rolling_shutter;
  r.camera_origin = choice<RenderRequest::Origin>(
      "camera_origin", camera_origin,
      {{"film", RenderRequest::Origin::film}, {"front", RenderRequest::Origin::front}});
  r.near_distance = near_distance, r.far_distance = far_distance;
  r.region = region, r.sample_range = sample_range, r.scene_time = scene_time;
  r.light_groups = light_groups, r.denoise_light = denoise_light;
  return r;
}
#define PETZVAL_RENDER_ARGUMENTS                                                                            \
  nb::arg("scene"), nb::kw_only(),                                                                          \
      nb::arg("size").none() = nb::none(), nb::arg("wavelengths_nm") = Numbers(),                           \
      nb::arg("samples_per_pixel").none() = nb::none(), nb::arg("noise") = 0.0,                             \
      nb::arg("first_surfaces") = false, nb::arg("zones") = Zones(), nb::arg("pinhole") = false,            \
      nb::arg("film_diagonal_mm").none() = nb::none(), nb::arg("aperture_diameter_mm").none() = nb::none(), \
      nb::arg("diffraction") = false, nb::arg("max_depth").none() = nb::none(),                             \
      nb::arg("scene_unit_mm") = 1000.0, nb::arg("sky_cd_m2").none() = nb::none(),                          \
      nb::arg("absolute_spectra") = false, nb::arg("skip_unsupported") = false, nb::arg("checkpoint") = "", \
      nb::arg("checkpoint_seconds") = 60.0, nb::arg("sampling") = "exit-pupil",                             \
      nb::arg("focus_pixel").none() = nb::none(), nb::arg("focus_as_in_scene") = false,                     \
      nb::arg("camera_at").none() = nb::none(), nb::arg("look_at").none() = nb::none(),                     \
      nb::arg("field_of_view_deg").none() = nb::none(), nb::arg("light_scale") = 1.0,                       \
      nb::arg("camera_move").none() = nb::none(), nb::arg("look_move").none() = nb::none(),                 \
      nb::arg("rolling_shutter") = 0.0, nb::arg("camera_origin") = "film",                                  \
      nb::arg("near_distance").none() = nb::none(), nb::arg("far_distance").none() = nb::none(),            \
      nb::arg("region").none() = nb::none(), nb::arg("sample_range").none() = nb::none(),                   \
      nb::arg("lights") = std::vector<std::string>(), nb::arg("scene_time") = 0.0,                          \
      nb::arg("light_groups") = false, nb::arg("denoise_light") = false

std::vector<std::int32_t> interleaved(const SceneSegments& seen) {
  std::vector<std::int32_t> values;
  values.reserve(3 * seen.shape.size());
  for (std::size_t i = 0; i < seen.shape.size(); ++i)
    values.insert(values.end(), {seen.shape[i], seen.instance[i], seen.material[i]});
  return values;
}

/// `render` as a function with the keywords of renderings and of light that goes astray.
template <typename... OfRender, typename... OfFlare>
auto render_function(RenderRequest (*)(const CameraInPython&, OfRender...), FlareOptions (*)(OfFlare...)) {
  return [](const CameraInPython& camera, OfRender... of_render, OfFlare... of_flare, bool segments,
            bool flow, int threads, std::uint64_t seed, const nb::object& progress) {
    const RenderRequest asked = request_of(camera, of_render...);
    const FlareOptions flare = flare_options(of_flare...);
    if (asked.is_piece() && (flare.any() || segments || flow))
      throw InputError(
          "a piece of a picture is its light alone; `suns`, `ghosts`, `segments` and `flow` of the whole "
          "picture would be right");
    if (asked.light_groups && flare.any())
      throw InputError(
          "suns, ghosts and starbursts belong to no light of the scene; without `light_groups`, or "
          "without them, would be right");
    Call call({threads, seed, progress});
    return call([&](const Context& context) {
      PreparedScene scene = prepare_scene(asked, context);
      if (scene.wants_autofocus()) autofocus(scene, context);
      Maybe<FlareLayers> layers;
      if (flare.any()) layers = scene_flare(scene, flare, context);
      RenderingInPython made(render_scene(scene, context));
      if (layers) add_scene_flare(scene, flare, *layers, made.irradiance, context);
      made.flare = std::move(layers);
      if (segments) made.segments = interleaved(segments_seen(scene, context));
      if (flow) made.flow = flow_seen(scene, context);
      return made;
    });
  };
}

/// What a rendering would take.
template <typename... OfRender>
auto estimate_function(RenderRequest (*)(const CameraInPython&, OfRender...)) {
  return [](const CameraInPython& camera, OfRender... of_render, int threads, std::uint64_t seed,
            const nb::object& progress) {
    const RenderRequest asked = request_of(camera, of_render...);
    Call call({threads, seed, progress});
    const RenderEstimate cost =
        call([&](const Context& context) { return estimate_render(prepare_scene(asked, context), context); });
    nb::dict told;
    told["samples_per_pixel"] = cost.samples_per_pixel;
    told["seconds"] = cost.seconds;
    told["memory_bytes"] = cost.memory_bytes;
    told["probe_seconds"] = cost.probe_seconds;
    return told;
  };
}

/// Frames of one scene through several cameras, which share their paths.
template <typename... OfRender>
auto frames_function(RenderRequest (*)(const CameraInPython&, OfRender...)) {
  return [](const nb::sequence& cameras, OfRender... of_render, int threads, std::uint64_t seed,
            const nb::object& progress) {
    std::vector<RenderRequest> asked;
    for (const nb::handle camera : cameras)
      asked.push_back(request_of(nb::cast<const CameraInPython&>(camera), of_render...));
    Call call({threads, seed, progress});
    return call([&](const Context& context) {
      RenderSession session;
      std::vector<PreparedScene> frames;
      for (const RenderRequest& frame : asked) frames.push_back(session.prepare(frame, context));
      std::vector<RenderingInPython> pictures;
      for (Rendering& light : render_frames(frames, context)) pictures.emplace_back(std::move(light));
      return pictures;
    });
  };
}

FocusRun focus_on(const CameraInPython& camera, const std::string& scene, Maybe<std::pair<int, int>> size,
                  const Zones& zones, const std::string& measure, const std::string& search, int focus_step,
                  double focus_threshold, int samples_per_pixel, Maybe<int> most_evaluations,
                  Maybe<double> from_mm, Maybe<double> to_mm, Maybe<double> depth_mm,
                  Maybe<double> film_diagonal_mm, int threads, std::uint64_t seed,
                  const nb::object& progress) {
  RenderRequest r;
  r.scene = scene, r.camera = camera.value();
  if (size) r.columns = size->first, r.rows = size->second;
  r.film_diagonal_mm = film_diagonal_mm;
  AutofocusOptions& options = r.autofocus;
  options.zones = zones_from(zones);
  options.measure.measure = focus_measure_of(measure);
  options.measure.step = focus_step, options.measure.threshold = focus_threshold;
  options.depth_mm = depth_mm;
  options.search = autofocus_search_of(search);
  options.samples_per_pixel = samples_per_pixel, options.most_evaluations = most_evaluations;
  options.from_mm = from_mm, options.to_mm = to_mm;
  Call call({threads, seed, progress});
  return call([&](const Context& context) { return autofocus(r, context); });
}

/// A view (row, column, number) of what a rendering holds of its pixels, or None where it was not asked for.
template <typename T>
nb::object plane_of(nb::handle self, std::vector<T>& values, std::size_t numbers) {
  if (values.empty()) return nb::none();
  const SpectralImage& light = nb::cast<RenderingInPython&>(self).irradiance;
  const std::size_t shape[] = {static_cast<std::size_t>(light.rows()),
                               static_cast<std::size_t>(light.columns()), numbers};
  return nb::cast(Array<T>(values.data(), 3, shape, self));
}

/// A view of one of a rendering's planes, or None where it was not asked for.
template <std::vector<float> render::FirstSurfaces::*member>
nb::object first_surface(nb::handle self, std::size_t last) {
  auto& r = nb::cast<RenderingInPython&>(self);
  if (!r.first_surfaces) return nb::none();
  std::vector<float>& values = (*r.first_surfaces).*member;
  const auto rows = static_cast<std::size_t>(r.irradiance.rows()),
             columns = static_cast<std::size_t>(r.irradiance.columns());
  const std::vector<std::size_t> shape =
      last > 0 ? std::vector{rows, columns, last} : std::vector{rows, columns};
  return nb::cast(Array<float>(values.data(), shape.size(), shape.data(), self));
}

constexpr const char* render_text =
    "The light of a three-dimensional scene (pbrt-v4 text, .gltf, .glb or a bundled name) on the sensor, "
    "path-traced through every surface of the lens. `size`: (columns, rows). `noise` > 0: ends when that RMS "
    "error over mean light is reached. `zones`: (left, right, top, bottom) in fractions of the picture, for "
    "focus \"auto\". `focus_pixel`: (column, row) of what is to be sharp. `camera_at`, `look_at`: (x, y, z) "
    "[scene units]; `field_of_view_deg`: across the picture, without a lens. `camera_move`, `look_move`: how "
    "the camera and what is in the middle of its picture move while the shutter is open [scene units]; "
    "`rolling_shutter`: share of that time by which the last row begins after the first. `camera_origin`: "
    "film "
    "or front, what stands where the scene puts its camera. `near_distance`, `far_distance` [scene units]: "
    "nothing outside is seen. `region` (column, row, columns, rows) and `sample_range` (first, end): a piece "
    "for `checkpoint`, which merge_renderings() puts together with others. `scene_time`: what moves in the "
    "scene (ActiveTransform) stands "
    "where it is then. `suns`, `ghosts` and `starburst` "
    "as "
    "of `image`; the rendering's `flare` has their layers. `first_surfaces`, `segments` and `flow` add what "
    "is "
    "known of each pixel, `light_groups` what each light gives. `denoise_light` takes most of the noise out; "
    "the light's `provenance` says so. Raises InputError; Cancelled.";

}  // namespace

void bind_render(nb::class_<CameraInPython>& camera, nb::module_& module) {
  nb::class_<RenderingInPython>(module, "Rendering", "What comes of rendering.")
      .def_prop_ro(
          "light", [](RenderingInPython& r) -> SpectralImage& { return r.irradiance; },
          nb::rv_policy::reference_internal, "The irradiance on the sensor.")
      .def_prop_ro(
          "light_groups",
          [](nb::handle self) {
            nb::list lights;
            for (SpectralImage& each : nb::cast<RenderingInPython&>(self).light_groups)
              lights.append(nb::cast(each, nb::rv_policy::reference_internal, self));
            return lights;
          },
          "What each light of the scene gives, by the numbers that `lights` has; the sum is `light`. Empty "
          "unless asked for.")
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
            auto& r = nb::cast<RenderingInPython&>(self);
            if (!r.first_surfaces) return nb::none();
            const SpectralImage& light = r.irradiance;
            return nb::cast(bands_view(r.first_surfaces->albedo.data(), light.rows(), light.columns(),
                                       light.bands(), self));
          },
          "What the surfaces reflect of the light that falls on them, 0 to 1, (row, column, wavelength).")
      .def_prop_ro(
          "share", [](nb::handle self) { return first_surface<&render::FirstSurfaces::share>(self, 0); },
          "Of the rays that met a surface, (row, column).")
      .def_prop_ro(
          "flare", [](RenderingInPython& r) { return r.flare ? &*r.flare : nullptr; },
          nb::rv_policy::reference_internal,
          "The Flare that `light` has, layer by layer; None unless `suns`, `ghosts` or `starburst`.")
      .def_prop_ro(
          "segments",
          [](nb::handle self) { return plane_of(self, nb::cast<RenderingInPython&>(self).segments, 3); },
          "What the middle of each pixel sees: (row, column, 3) of int32, the numbers of shape, placed "
          "object "
          "and material in the scene, -1 for none; None unless asked for.")
      .def_prop_ro(
          "flow", [](nb::handle self) { return plane_of(self, nb::cast<RenderingInPython&>(self).flow, 2); },
          "How far what a pixel's middle sees moves while its row is exposed [pixels]: (row, column, 2) to "
          "the "
          "right and down, NaN where nothing is seen; None unless asked for.")
      .def_prop_ro("rays", [](const RenderingInPython& r) { return r.rays; })
      .def_prop_ro(
          "passed", [](const RenderingInPython& r) { return r.passed; }, "Rays that got through the lens.")
      .def_prop_ro("samples_per_pixel", [](const RenderingInPython& r) { return r.samples_per_pixel; })
      .def_prop_ro(
          "denoised", [](const RenderingInPython& r) { return r.denoised; }, "Whether `light` was denoised.")
      .def_prop_ro(
          "noise", [](const RenderingInPython& r) { return r.noise; }, "Estimate, if it was asked for.")
      .def("__repr__", [](const RenderingInPython& r) {
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
  camera.def("render", render_function(request_of, flare_options), PETZVAL_RENDER_ARGUMENTS,
             PETZVAL_FLARE_KEYWORDS, nb::arg("segments") = false, nb::arg("flow") = false,
             PETZVAL_SEEDED_CALL_KEYWORDS, render_text);
  camera.def("estimate_render", estimate_function(request_of), PETZVAL_RENDER_ARGUMENTS,
             PETZVAL_SEEDED_CALL_KEYWORDS,
             "What `render` with these keywords would take, from a small picture: a dict with "
             "`samples_per_pixel`, `seconds`, `memory_bytes` and `probe_seconds`. Raises InputError; "
             "Cancelled.");
  module.def(
      "render_frames", frames_function(request_of), nb::arg("cameras"), PETZVAL_RENDER_ARGUMENTS,
      PETZVAL_SEEDED_CALL_KEYWORDS,
      "The light of a three-dimensional scene through several cameras that differ in lens and focus "
      "alone, four or more, as in a focus pull: a list of Renderings, no noisier than "
      "`samples_per_pixel` paths each, in a fraction of the time, for a path serves every frame whose "
      "lens lets it through (balance heuristic). Keywords are those of Camera.render(). The bytes of a "
      "frame depend on all of them. Raises InputError for what frames cannot share (autofocus, "
      "`diffraction`, `noise`, `first_surfaces`, `denoise_light`, `light_groups`, checkpoints and "
      "pieces, a camera that moves); Cancelled.");
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
      nb::arg("focus_step") = FocusMeasureOptions().step,
      nb::arg("focus_threshold") = FocusMeasureOptions().threshold, nb::arg("samples_per_pixel") = 16,
      nb::arg("most_evaluations") = nb::none(), nb::arg("from_mm").none() = nb::none(),
      nb::arg("to_mm").none() = nb::none(), nb::arg("depth_mm").none() = nb::none(),
      nb::arg("film_diagonal_mm").none() = nb::none(), nb::arg("threads") = 0, nb::arg("seed") = 1,
      nb::arg("progress").none() = nb::none(),
      "The film distance at which the zones of a three-dimensional scene are sharpest, as a FocusRun. "
      "`focus_measure`: sml, gradient or laplacian, of differences `focus_step` pixels apart; "
      "`focus_threshold`: modified Laplacians below it do not count. `focus_search`: brent, golden-2006 or "
      "scan, `from_mm` `to_mm` [film distances] in at most `most_evaluations` places; `depth_mm` of focus: "
      "its scale. Raises InputError; Cancelled.");
}

}  // namespace petzval::python
