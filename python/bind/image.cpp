// SPDX-License-Identifier: BSD-3-Clause
// The light of a flat scene on a sensor, and plans of it.
#include "image.h"

#include <fmt/format.h>
#include <petzval/simulate/image_pieces.h>
#include <petzval/simulate/imaging_session.h>

#include "constructor.h"
#include "scene.h"

namespace petzval::python {

ImageOptions image_options(const std::string& method, Maybe<double> tolerance, int supersample,
                           const std::string& surround, const std::string& interpolate,
                           const std::string& fit, Maybe<int> section, Maybe<int> transform, Maybe<int> nodes,
                           Maybe<int> tile, int layers, Maybe<double> least_scene_angle_deg,
                           Maybe<std::array<int, 2>> bands, const std::string& checkpoint) {
  ImageOptions options;
  ImagingOptions& imaging = options.imaging;
  imaging.method = choice<BlurMethod>("method", method,
                                      {{"product", BlurMethod::product},
                                       {"blended", BlurMethod::blended},
                                       {"sections", BlurMethod::sections},
                                       {"exact", BlurMethod::exact},
                                       {"none", BlurMethod::none}});
  if (tolerance) imaging.product.tolerance = *tolerance;
  if (nodes) imaging.product.nodes = *nodes;
  if (tile) imaging.product.tile = *tile;
  if (section) imaging.sections.section = *section;
  if (transform) imaging.sections.transform = *transform;
  imaging.supersample = supersample;
  imaging.surround =
      choice<Surround>("surround", surround,
                       {{"error", Surround::error}, {"zero", Surround::zero}, {"extend", Surround::extend}});
  imaging.interpolation = choice<PsfInterpolation>(
      "interpolate", interpolate, {{"psf", PsfInterpolation::psf}, {"otf", PsfInterpolation::otf}});
  imaging.fit = RadialFit::parse(fit);
  options.depth.layers = layers;
  options.least_scene_angle_deg = least_scene_angle_deg;
  options.bands = bands, options.checkpoint = checkpoint;
  return options;
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

namespace {

struct LightAndReport {
  SpectralImage light;
  ImageReport report;
};

LightAndReport light_of(Optics optics, const nb::object& scene, const ImageOptions& options,
                        const CallOptions& how) {
  SceneChoice chosen = scene_from(scene);
  Call call(how);
  return call([&](const Context& context) {
    ImageReport report;
    SpectralImage light =
        std::holds_alternative<SceneRequest>(chosen)
            ? image(std::get<SceneRequest>(chosen), std::move(optics), options, context, &report)
            : image(std::get<Scene>(std::move(chosen)), std::move(optics), options, context, &report);
    return LightAndReport{std::move(light), std::move(report)};
  });
}

SpectralImage image_of(Optics optics, const nb::object& scene, const ImageOptions& options,
                       const CallOptions& how) {
  return light_of(std::move(optics), scene, options, how).light;
}

std::pair<SpectralImage, FlareLayers> image_and_flare_of(Optics optics, const nb::object& scene,
                                                         const ImageOptions& options,
                                                         const CallOptions& how) {
  if (!options.flare.any())
    throw InputError(
        "no light goes astray unless it is asked for; `suns`, `ghosts` or `starburst` would be right");
  LightAndReport made = light_of(std::move(optics), scene, options, how);
  return {std::move(made.light), std::move(made.report.flare).value_or(FlareLayers())};
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

void piece_of(Optics optics, const nb::object& scene, const ImageOptions& options, const CallOptions& how) {
  const ImagePlan plan = plan_of(std::move(optics), scene, options, how);
  Call call(how);
  call([&](const Context& context) { image_piece(plan, context); });
}

/// `make` as a function with the keywords of images and of light that goes astray.
template <typename Self, auto make, typename... OfImage, typename... OfFlare>
auto function_of(ImageOptions (*)(OfImage...), FlareOptions (*)(OfFlare...)) {
  return [](const Self& self, const nb::object& scene, OfImage... of_image, OfFlare... of_flare, int threads,
            const nb::object& progress) {
    ImageOptions options = image_options(of_image...);
    options.flare = flare_options(of_flare...);
    return make(optics_of(self), scene, options, {threads, 1, progress});
  };
}

#define PETZVAL_IMAGE_ARGUMENTS \
  nb::arg("scene"), nb::kw_only(), PETZVAL_IMAGE_KEYWORDS, PETZVAL_FLARE_KEYWORDS, PETZVAL_CALL_KEYWORDS

/// `shape` of a session, whose images all have the keywords.
template <typename... OfImage, typename... OfFlare>
auto session_maker(ImageOptions (*)(OfImage...), FlareOptions (*)(OfFlare...)) {
  return [](const nb::object& scene, OfImage... of_image, OfFlare... of_flare) {
    ImageOptions options = image_options(of_image...);
    options.flare = flare_options(of_flare...);
    SceneChoice chosen = scene_from(scene);
    if (auto* request = std::get_if<SceneRequest>(&chosen))
      return ImagingSession(std::move(*request), std::move(options));
    return ImagingSession(std::get<Scene>(std::move(chosen)), std::move(options));
  };
}

template <typename Self>
SpectralImage session_image(ImagingSession& session, const Self& optics, int threads,
                            const nb::object& progress) {
  Call call({threads, 1, progress});
  return call([&](const Context& context) { return session.image(optics_of(optics), context); });
}

constexpr const char* image_text =
    "The light of a flat scene on the sensor, a SpectralImage (row, column, wavelength) [W/(m2 nm)]. "
    "`scene`: "
    "a name, a SceneRequest, or a Scene in memory. `method` of the blur: product (to a relative L2 error of "
    "`tolerance`, 1e-3), blended, sections, exact or none; `nodes`, `tile` [cells], `section` [cells] and "
    "`transform` [cells] set what these choose; `supersample`: cells along a side of a pixel, 0: as many as "
    "the tolerance needs; `surround` of a scene that is too small: error, zero or extend; `layers` of a "
    "scene "
    "with depth, 0: as many as needed. `suns` (Sun, or text as \"20,15:80000\") are added to the scene; "
    "`ghosts` and `starburst` add what two surfaces reflect and the stop's edges diffract of suns and of the "
    "scene's samples brighter than `ghost_threshold` times its mean, but for the faintest `ghost_neglect` of "
    "the ghosts' light, of `ghost_reflections` 2 or 4; `scatter` of the lens's surfaces, as "
    "roughness=1.5,dust=0.02, or lens for what its "
    "file "
    "says (docs/FLARE.md); `scatter_surround` beyond the frame: dark or mean. `checkpoint`: the file that "
    "merge_images() made, whose "
    "bands are not formed again. `progress(fraction, what)` may "
    "return False to stop. Raises InputError; Cancelled.";
constexpr const char* image_and_flare_text =
    "As `image`, and takes the same keywords: the light with all that goes astray, and a Flare with each "
    "layer by itself.";
constexpr const char* piece_text =
    "Forms some bands of what `image` with the same keywords would give, those from `bands[0]` up to "
    "`bands[1]`, into the file `checkpoint`; merge_images() puts them together with those of other "
    "processes.";
constexpr const char* plan_text =
    "What `image` does before it computes light: scene, table of the lens, frame. Takes the same keywords.";

void bind_image_plan(nb::module_& module) {
  nb::class_<SensorGeometry>(module, "Frame", "Where the pixels are, centred on the axis.")
      .def_ro("columns", &SensorGeometry::columns)
      .def_ro("rows", &SensorGeometry::rows)
      .def_ro("pitch_um", &SensorGeometry::pitch_um)
      .def("__repr__", [](const SensorGeometry& g) {
        return fmt::format("Frame({} x {} at {:g} um)", g.columns, g.rows, g.pitch_um);
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
  nb::class_<ImagingSession>(
      module, "ImagingSession", nb::type_slots(explained_constructor),
      "One flat scene through one camera after the other. Keeps what an alteration leaves valid: the scene, "
      "the table of the last lens, the last image. Gives the bytes of Camera.image().")
      .def(nb::new_(session_maker(image_options, flare_options)), nb::arg("scene"), nb::kw_only(),
           PETZVAL_IMAGE_KEYWORDS, PETZVAL_FLARE_KEYWORDS, "Keywords are those of Camera.image().")
      .def("image", session_image<CameraInPython>, nb::arg("camera"), nb::kw_only(), nb::arg("threads") = 0,
           nb::arg("progress").none() = nb::none(), "The light on the sensor.")
      .def("image", session_image<TableCamera>, nb::arg("camera"), nb::kw_only(), nb::arg("threads") = 0,
           nb::arg("progress").none() = nb::none());
}

}  // namespace

void bind_image(nb::class_<CameraInPython>& camera, nb::class_<TableCamera>& table_camera,
                nb::module_& module) {
  bind_image_plan(module);
  const auto add = []<typename Self>(nb::class_<Self>& type) {
    type.def("image", function_of<Self, image_of>(image_options, flare_options), PETZVAL_IMAGE_ARGUMENTS,
             image_text)
        .def("image_and_flare", function_of<Self, image_and_flare_of>(image_options, flare_options),
             PETZVAL_IMAGE_ARGUMENTS, image_and_flare_text)
        .def("image_piece", function_of<Self, piece_of>(image_options, flare_options),
             PETZVAL_IMAGE_ARGUMENTS, piece_text)
        .def("plan", function_of<Self, plan_of>(image_options, flare_options), PETZVAL_IMAGE_ARGUMENTS,
             plan_text);
  };
  add(camera);
  add(table_camera);
  module.def(
      "merge_images",
      [](const std::vector<std::string>& pieces, const std::string& checkpoint, const nb::object& progress) {
        Call call({0, 1, progress});
        call([&](const Context& context) { merge_images(pieces, checkpoint, context); });
      },
      nb::arg("pieces"), nb::arg("checkpoint"), nb::kw_only(), nb::arg("progress").none() = nb::none(),
      "Puts the pieces of an image together, the checkpoints of Camera.image_piece(), in any order: "
      "Camera.image() with `checkpoint` is the image that one process would have formed, the same bytes. "
      "Raises InputError; Cancelled.");
}

}  // namespace petzval::python
