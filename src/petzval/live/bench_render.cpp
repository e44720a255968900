// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/live/bench_render.h>
#include <petzval/simulate/scene_depth.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace petzval {

namespace {

/// What a quality costs. One path serves eight bands, as many as all but the finest have.
struct RenderCost {
  const char* name;
  int most_columns, samples;
  double first_nm, step_nm;  ///< of bands up to 700 nm
};
constexpr RenderCost render_preview{"preview", 160, 4, 420, 40}, render_full{"full", 320, 128, 420, 40},
    render_finest{"finest", 640, 128, 400, 10};
constexpr double last_nm = 700;
constexpr double rendered_neglect = 1e-2;
constexpr double between_pictures_s = 0.5;  // between pictures of one that is under way

RenderRequest render_request(const BenchState& state, const Camera& camera, const Sensor& sensor,
                             const RenderCost& cost) {
  RenderRequest request;
  request.scene = state.scene;
  request.camera = camera;
  request.camera.sensor = sensor;
  for (double nm = cost.first_nm; nm <= last_nm; nm += cost.step_nm) request.wavelengths_nm.push_back(nm);
  request.samples_per_pixel = cost.samples;
  return request;
}

}  // namespace

void BenchRender::show(const BenchState& state, const Camera& camera, const std::string& sensor_path,
                       PictureQuality quality, const Context& context, const SendReply& send) {
  const bool preview = quality == PictureQuality::preview, finest = quality == PictureQuality::finest;
  Shot& shot = preview ? preview_ : finest ? finest_ : full_;
  const RenderCost& cost = preview ? render_preview : finest ? render_finest : render_full;
  const std::string light_key =
      fmt::format("{}|{}|{}|{}", state.camera_key(), state.stray_key(), state.scene, state.sensor);
  const std::string shown_key = light_key + '|' + state.shot_key();
  if (shot.shown_key == shown_key) return;
  shot.shown_key.clear();
  if (finest_.light_key != light_key) finest_.light.reset();  // its memory, which nothing needs any more
  finest_.shown_key.clear();
  shot.outputs = output_options(state);
  const auto send_light = [&](const SpectralImage& light, const char* name, int samples) {
    send_picture(light, shot.sensor, shot.outputs,
                 {{"id", state.id},
                  {"quality", name},
                  {"wavelengths", fmt::format("{:g}:{:g}:{:g}", cost.first_nm, cost.step_nm, last_nm)},
                  {"samples", samples},
                  {"samples_wanted", cost.samples},
                  {"sources", nlohmann::json::array()},
                  {"neglected_ghosts", rendered_neglect}},
                 context, send);
  };
  if (shot.light_key != light_key || !shot.light) {
    shot.light_key.clear();
    shot.light.reset();
    shot.sensor.choose(sensor_path, cost.most_columns);
    shot.scene =
        shot.session.prepare(render_request(state, camera, shot.sensor.binned.sensor, cost), context);
    if (shot.scene->wants_autofocus()) autofocus(*shot.scene, context);
    const FlareOptions flare = flare_options(state, rendered_neglect);
    const FlareLayers layers = flare.any() ? scene_flare(*shot.scene, flare, context) : FlareLayers();
    const auto with_flare = [&](SpectralImage light) {
      FlareLayers here = layers;  // what scatters is of this light
      if (flare.any()) add_scene_flare(*shot.scene, flare, here, light, context);
      return light;
    };
    PictureWatch watch;
    if (!preview) {
      // The finest picture replaces the full one when it has as many rays in each area of the sensor.
      const double from = finest ? render_full.samples * full_.pixels() / shot.pixels() : 0;
      watch.every_s = between_pictures_s;
      watch.show = [&, from](const Rendering& so_far, bool stopped) {
        if (!stopped && so_far.samples_per_pixel >= from)
          send_light(with_flare(so_far.irradiance), "refining", so_far.samples_per_pixel);
      };
    }
    shot.light = with_flare(render_scene(*shot.scene, context, watch).irradiance);
    shot.light_key = light_key;
  }
  send_light(*shot.light, cost.name, cost.samples);
  shot.shown_key = shown_key;
}

double BenchRender::distance_m(const std::array<double, 2>& place_mm) const {
  if (!preview_.scene) throw InputError("there is no picture yet");
  const SensorGeometry& film = preview_.scene->film;
  const auto pixel = [](double share, int count) {
    return std::clamp(std::floor(share * count), 0.0, count - 1.0);
  };
  const double distance =
      depth_of_pixel_m(*preview_.scene, {pixel(place_mm[0] / film.width_mm() + 0.5, film.columns),
                                         pixel(0.5 - place_mm[1] / (film.height_mm()), film.rows)});
  if (!std::isfinite(distance)) throw InputError("nothing is seen there that could be focused on");
  return distance;
}

void BenchRender::write(const std::string& path, const Context& context) const {
  const Shot& shot = finest_.is_shown() ? finest_ : full_;
  if (!shot.is_shown()) throw InputError("there is no full picture yet; wait until it is no preview");
  write_outputs(*shot.light, {path}, shot.sensor.binned.sensor, shot.outputs, context);
}

}  // namespace petzval
