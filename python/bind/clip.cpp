// SPDX-License-Identifier: BSD-3-Clause
// Clips: frames of a scene that moves, of rows that begin one after the other, of light that flickers.
#include <fmt/format.h>
#include <petzval/base/file_extension.h>
#include <petzval/simulate/clip.h>
#include <petzval/simulate/vibration.h>

#include <memory>

#include "image.h"
#include "scene.h"

namespace petzval::python {

namespace {

/// A clip, and what it was made with.
struct ClipInPython {
  template <typename LightOfClip>
  ClipInPython(LightOfClip plan, const Sensor& of_sensor, const ClipOptions& asked, std::uint64_t with_seed,
               const Context& context)
      : sensor(of_sensor), options(asked), seed(with_seed), clip(std::move(plan), sensor, asked, context) {}

  Sensor sensor;
  ClipOptions options;
  std::uint64_t seed;
  Clip clip;
};

// ---- what is asked for

Shutter shutter_of(const Sensor& sensor, const std::string& word, Maybe<double> row_time_us) {
  enum class Kind { of_sensor, global, rolling };
  const Kind kind = choice<Kind>(
      "shutter", word, {{"sensor", Kind::of_sensor}, {"global", Kind::global}, {"rolling", Kind::rolling}});
  Shutter shutter = kind == Kind::global ? Shutter{} : sensor.require_electronics().shutter;
  if (kind == Kind::rolling) shutter.kind = Shutter::Kind::rolling;
  const bool rolls = shutter.kind == Shutter::Kind::rolling;
  if (row_time_us && !rolls)
    throw InputError("`row_time_us` is of a rolling shutter; shutter=\"rolling\" would be right with it");
  constexpr double s_per_us = 1e-6;
  if (row_time_us) shutter.row_time_s = *row_time_us * s_per_us;
  if (rolls && !(shutter.row_time_s > 0))
    throw InputError(
        fmt::format("sensor {} has no row time; `row_time_us` 20 would be right, for example", sensor.name));
  return shutter;
}

/// The way of a file, or of keys (t_s, pan_deg, pitch_deg, right_m, up_m).
MotionPath path_of(const nb::object& path) {
  if (nb::isinstance<nb::str>(path) || nb::hasattr(path, "__fspath__"))
    return MotionPath::read(nb::cast<std::string>(nb::str(path)));
  std::vector<std::array<double, 5>> rows;
  if (!nb::try_cast(path, rows))
    throw InputError(
        "`path` is neither a file nor rows of numbers; a .csv or keys (t_s, pan_deg, pitch_deg, right_m, "
        "up_m) "
        "would be right");
  std::vector<MotionPath::Key> keys;
  for (const auto& [t_s, pan_deg, pitch_deg, right_m, up_m] : rows)
    keys.push_back({t_s, {pan_deg, pitch_deg, right_m, up_m}});
  return MotionPath(std::move(keys));
}

struct ClipRequest {
  ClipOptions options;
  std::string shutter;
  Maybe<double> row_time_us;
  SceneAim per_second;
  nb::object path;
  std::string vibration;
  Maybe<int> samples_per_pixel = {};

  /// All that is known once the sensor is.
  ClipOptions with(const Sensor& sensor, std::uint64_t seed) const {
    ClipOptions result = options;
    result.shutter = shutter_of(sensor, shutter, row_time_us);
    const bool has_path = !path.is_none();
    if (has_path && !per_second.is_straight())
      throw InputError(
          "`path` says all that moves; without `pan_deg_per_s`, `pitch_deg_per_s` and `move_m_per_s` it "
          "would "
          "be right");
    result.validate();
    const double lasts_s = result.duration_s() + result.shutter->row_delay_s(sensor.geometry.rows);
    result.motion = has_path ? path_of(path) : MotionPath::steady(per_second, lasts_s);
    if (!vibration.empty())
      result.motion = VibrationSpectrum::parse(vibration).shaken(result.motion, lasts_s, seed);
    return result;
  }
};

ClipRequest clip_request(int frames, double fps, double pan_deg_per_s, double pitch_deg_per_s,
                         std::pair<double, double> move_m_per_s, const nb::object& path,
                         const std::string& vibration, const std::string& shutter, Maybe<double> row_time_us,
                         const std::string& flicker, double motion_step_px, int instants,
                         Maybe<int> samples_per_pixel) {
  ClipRequest request{{},   shutter,   row_time_us,      {pan_deg_per_s, pitch_deg_per_s, 0, 0},
                      path, vibration, samples_per_pixel};
  std::tie(request.per_second.right_m, request.per_second.up_m) = move_m_per_s;
  request.options.frames = frames, request.options.fps = fps;
  request.options.flicker = LampFlicker::parse(flicker);
  request.options.step_px = motion_step_px, request.options.instants = instants;
  return request;
}
#define PETZVAL_CLIP_ARGUMENTS                                                                              \
  nb::arg("scene"), nb::arg("frames"), nb::kw_only(),                                                       \
      nb::arg("fps") = 24.0, nb::arg("pan_deg_per_s") = 0.0, nb::arg("pitch_deg_per_s") = 0.0,              \
      nb::arg("move_m_per_s") = std::pair(0.0, 0.0), nb::arg("path").none() = nb::none(),                   \
      nb::arg("vibration") = "", nb::arg("shutter") = "sensor", nb::arg("row_time_us").none() = nb::none(), \
      nb::arg("flicker") = "none", nb::arg("motion_step_px") = ClipOptions().step_px,                       \
      nb::arg("instants") = ClipOptions().instants, nb::arg("samples_per_pixel").none() = nb::none()

Sensor sensor_of(const Optics& optics) {
  const auto sensor = std::visit([](const auto& each) { return each.sensor; }, optics);
  if (!sensor || !sensor->electronics)
    throw InputError(
        "`sensor`: a clip needs one that counts photons; Camera(lens, sensor=\"third-inch-1280x960\") would "
        "be "
        "right");
  return *sensor;
}

/// A file of a scene in three dimensions.
bool is_in_space(const nb::object& scene) {
  if (!nb::isinstance<nb::str>(scene) && !nb::hasattr(scene, "__fspath__")) return false;
  const std::string extension = extension_of(nb::cast<std::string>(nb::str(scene)));
  return extension == ".pbrt" || extension == ".gltf" || extension == ".glb";
}

std::shared_ptr<ClipInPython> shot_in_space(Optics optics, const nb::object& scene, const ClipRequest& clip,
                                            const ClipOptions& options, const CallOptions& how) {
  const Sensor sensor = sensor_of(optics);
  Camera* camera = std::get_if<Camera>(&optics);
  if (!camera)
    throw InputError("a scene in three dimensions is seen through a lens; a Camera would be right");
  RenderRequest request;
  request.scene = nb::cast<std::string>(nb::str(scene));
  request.camera = std::move(*camera);
  request.samples_per_pixel = clip.samples_per_pixel;
  Call call(how);
  return call([&](const Context& context) {
    return std::make_shared<ClipInPython>(request, sensor, options, context.seed, context);
  });
}

std::shared_ptr<ClipInPython> shot(Optics optics, const nb::object& scene, const ImageOptions& image,
                                   const ClipOptions& options, const CallOptions& how) {
  const Sensor sensor = sensor_of(optics);
  SceneChoice chosen = scene_from(scene);
  Call call(how);
  return call([&](const Context& context) {
    ImagePlan plan =
        std::holds_alternative<SceneRequest>(chosen)
            ? plan_clip(std::get<SceneRequest>(chosen), std::move(optics), image, options.motion, context)
            : plan_image(std::get<Scene>(std::move(chosen)), std::move(optics), image, context);
    return std::make_shared<ClipInPython>(std::move(plan), sensor, options, context.seed, context);
  });
}

/// Shooting as a function with the keywords of clips, images and exposures.
template <typename Self, typename... OfClip, typename... OfImage, typename... OfExposure>
auto shoot_function(ClipRequest (*)(OfClip...), ImageOptions (*)(OfImage...),
                    ExposeOptions (*)(OfExposure...)) {
  return [](const Self& self, const nb::object& scene, OfClip... of_clip, OfImage... of_image,
            OfExposure... of_exposure, int threads, std::uint64_t seed, const nb::object& progress) {
    Optics optics = optics_of(self);
    ClipRequest request = clip_request(of_clip...);
    request.options.expose = expose_options(of_exposure...);
    const ClipOptions options = request.with(sensor_of(optics), seed);
    if (is_in_space(scene))
      return shot_in_space(std::move(optics), scene, request, options, {threads, seed, progress});
    return shot(std::move(optics), scene, image_options(of_image...), options, {threads, seed, progress});
  };
}

constexpr const char* shoot_text =
    "A Clip of `frames` frames: a sequence of Raws, each made when it is asked for. The camera turns by "
    "`pan_deg_per_s` to the right and `pitch_deg_per_s` up before a scene at infinity or a panorama; the "
    "scene "
    "moves by `move_m_per_s` (right, up) at a finite distance; or both follow `path`, a .csv or keys (t_s, "
    "pan_deg, pitch_deg, right_m, up_m). `vibration` on top: 0.02@1-20 (degrees rms, from and to Hz) or a "
    ".csv of "
    "spectral densities. `shutter`: global, rolling with `row_time_us`, or as the sensor "
    "says. "
    "`flicker` of all light: none, mains:50:0.4 (Hz of the mains, depth) or pwm:1000:0.25 (Hz, duty), :PHASE "
    "in periods behind it. Light is worked out anew when the picture has moved by `motion_step_px`. A .pbrt "
    "file is rendered: what "
    "moves in it (ActiveTransform, seconds) at `instants` instants an exposure, `samples_per_pixel` each, at "
    "the wavelengths of 400 to 700 nm. Other "
    "keywords are those of `image` and `expose`; automatic exposure is settled once. Raises InputError; "
    "Cancelled. docs/CLIPS.md.";

// ---- what comes of it

RawImage frame_of(const ClipInPython& self, int index, int threads, const nb::object& progress) {
  Call call({threads, self.seed, progress});
  return call([&](const Context& context) { return self.clip.frame(index, context); });
}

/// As of a list: from the end below 0. \throws nb::index_error.
RawImage item_of(const ClipInPython& self, int index) {
  const int place = index < 0 ? index + self.options.frames : index;
  if (place < 0 || place >= self.options.frames) throw nb::index_error("the clip has no such frame");
  return frame_of(self, place, 0, nb::none());
}

EventCameraOptions event_options(const ClipInPython& clip,
                                 const std::variant<double, std::pair<double, double>>& threshold,
                                 double mismatch, double latency_s, double refractory_s, double noise_per_s) {
  EventCameraOptions options;
  if (const auto* both = std::get_if<double>(&threshold))
    options.threshold_on = options.threshold_off = *both;
  else
    std::tie(options.threshold_on, options.threshold_off) = std::get<1>(threshold);
  options.threshold_mismatch = mismatch, options.time_constant_s = latency_s;
  options.refractory_s = refractory_s, options.noise_per_s = noise_per_s;
  options.seed = clip.seed;
  options.serial = clip.sensor.electronics->serial;
  if (clip.sensor.electronics->dark_current_e_per_s > 0)
    options.dark_e_per_s = clip.sensor.electronics->dark_current_e_per_s;
  options.validate();
  return options;
}

nb::object events_of(const ClipInPython& self,
                     const std::variant<double, std::pair<double, double>>& threshold, double mismatch,
                     double latency_s, double refractory_s, double noise_per_s, int threads,
                     const nb::object& progress) {
  const EventCameraOptions camera =
      event_options(self, threshold, mismatch, latency_s, refractory_s, noise_per_s);
  Numbers t_s;
  std::vector<std::int32_t> column, row;
  std::vector<std::uint8_t> brighter;
  Call call({threads, self.seed, progress});
  call([&](const Context& context) {
    self.clip.events(
        camera,
        [&](const std::vector<Event>& events) {
          for (const Event& event : events) {
            t_s.push_back(event.t_s);
            column.push_back(event.column), row.push_back(event.row);
            brighter.push_back(event.brighter ? 1 : 0);
          }
        },
        context);
    return true;
  });
  const std::size_t count = t_s.size();
  return call_python("petzval._tables", "Events", array_of(std::move(t_s)),
                     array_of(std::move(column), {count}), array_of(std::move(row), {count}),
                     array_of(std::move(brighter), {count}));
}

nb::tuple timing_of(const ClipInPython& self, int frame, std::size_t exposure) {
  const FrameTiming timing = self.clip.timing(frame, exposure);
  return nb::make_tuple(timing.start_s, timing.end_s(self.sensor.geometry.rows));
}

bool rolls(const ClipInPython& self) {
  return self.clip.shutter().kind == Shutter::Kind::rolling;
}

}  // namespace

void bind_clip(nb::class_<CameraInPython>& camera, nb::class_<TableCamera>& table_camera,
               nb::module_& module) {
  nb::class_<ClipInPython>(module, "Clip",
                           "Frames of a scene that moves or of light that flickers: a sequence of Raws. A "
                           "frame has the same bytes "
                           "whenever it is made.")
      .def("__len__", [](const ClipInPython& self) { return self.options.frames; })
      .def("__getitem__", item_of, nb::arg("index"))
      .def("frame", frame_of, nb::arg("index"), nb::kw_only(), PETZVAL_CALL_KEYWORDS,
           "A frame as a Raw, from 0 on. Raises InputError for one that the clip does not have; Cancelled.")
      .def("events", events_of, nb::kw_only(),
           nb::arg("threshold") = std::variant<double, std::pair<double, double>>(0.2),
           nb::arg("mismatch") = 0.0, nb::arg("latency_s") = 0.0, nb::arg("refractory_s") = 0.0,
           nb::arg("noise_per_s") = 0.0, PETZVAL_CALL_KEYWORDS,
           "What an event camera with these pixels tells from the beginning to the end of the clip, as "
           "Events. "
           "`threshold`: change of the logarithm of the light that makes an event, or (brighter, darker); "
           "`mismatch`: its rms over pixels, relative; `latency_s`: time constant of the photoreceptor; "
           "`refractory_s`: rest of a pixel after an event; `noise_per_s`: events of noise a pixel. Raises "
           "InputError; Cancelled.")
      .def_prop_ro("frames", [](const ClipInPython& self) { return self.options.frames; })
      .def_prop_ro("fps", [](const ClipInPython& self) { return self.options.fps; })
      .def_prop_ro(
          "exposure_s", [](const ClipInPython& self) { return self.clip.exposure_s(); },
          "Of each frame, as it was settled.")
      .def_prop_ro(
          "shutter", [](const ClipInPython& self) { return rolls(self) ? "rolling" : "global"; },
          "global or rolling.")
      .def_prop_ro(
          "row_time_s", [](const ClipInPython& self) { return self.clip.shutter().row_time_s; },
          "From one row of a rolling shutter to the next.")
      .def("timing", timing_of, nb::arg("frame"), nb::arg("exposure") = 0,
           "(begin of the first row, end of the last) [s] of a frame, or of an exposure of a bracket.")
      .def(
          "instants", [](const ClipInPython& self, int frame) { return self.clip.instants(frame); },
          nb::arg("frame"), "How many pictures of light a frame is made of.")
      .def("__repr__", [](const ClipInPython& self) {
        return fmt::format("<Clip: {} frames of {} x {}, {:g} a second, {:.3g} s each, {} shutter>",
                           self.options.frames, self.sensor.geometry.columns, self.sensor.geometry.rows,
                           self.options.fps, self.clip.exposure_s(), rolls(self) ? "rolling" : "global");
      });
  camera.def("shoot", shoot_function<CameraInPython>(clip_request, image_options, expose_options),
             PETZVAL_CLIP_ARGUMENTS, PETZVAL_IMAGE_KEYWORDS, PETZVAL_EXPOSE_KEYWORDS,
             PETZVAL_SEEDED_CALL_KEYWORDS, shoot_text);
  table_camera.def("shoot", shoot_function<TableCamera>(clip_request, image_options, expose_options),
                   PETZVAL_CLIP_ARGUMENTS, PETZVAL_IMAGE_KEYWORDS, PETZVAL_EXPOSE_KEYWORDS,
                   PETZVAL_SEEDED_CALL_KEYWORDS, shoot_text);
}

}  // namespace petzval::python
