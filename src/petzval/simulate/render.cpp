// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/units.h>
#include <petzval/base/version.h>
#include <petzval/lens/first_order.h>
#include <petzval/render/camera/wave_image.h>
#include <petzval/render/film/checkpoint.h>
#include <petzval/render/lamps.h>
#include <petzval/sensor/lens_facts.h>
#include <petzval/simulate/framing.h>
#include <petzval/simulate/prepared_world.h>
#include <petzval/simulate/scene_lights.h>

#include <cmath>
#include <utility>

namespace petzval {

namespace {

constexpr int usual_samples = 64, most_samples_for_noise = 4096;

}  // namespace

render::RenderOptions sampling_of(const PreparedScene& scene, const Context& context) {
  const RenderRequest& request = scene.request;
  render::RenderOptions options = render_options(scene);
  options.samples_per_pixel = samples_asked(scene);
  options.noise = request.noise;
  options.seed = context.seed;
  options.first_surfaces = request.first_surfaces;
  options.denoise = request.denoise_light;
  options.light_groups = request.light_groups;
  options.checkpoint = request.checkpoint;
  options.checkpoint_seconds = request.checkpoint_seconds;
  if (const auto& at = request.region)
    options.piece.region = {(*at)[0], (*at)[1], (*at)[0] + (*at)[2], (*at)[1] + (*at)[3]};
  options.piece.samples = request.sample_range;
  options.motion = scene.world->camera.motion;
  if (!request.checkpoint.empty()) options.fingerprint = render_fingerprint(scene, options);
  return options;
}

void add_facts(const PreparedScene& scene, const Context& context, Rendering& picture) {
  picture.irradiance.provenance =
      fmt::format("petzval {} render: {} through {}; {} samples a pixel, seed {}", version(),
                  scene.request.scene, camera_text(scene), picture.samples_per_pixel, context.seed);
  if (picture.denoised)
    picture.irradiance.provenance += "; denoised by non-local means of light, albedo, normals and depth";
  if (!scene.request.first_surfaces) picture.first_surfaces.reset();
  if (scene.lens) picture.irradiance.lens = lens_facts(scene.lens->name, first_order(*scene.lens));
  for (std::size_t i = 0; i < picture.light_groups.size(); ++i) {
    SpectralImage& each = picture.light_groups[i];
    each.provenance = fmt::format("{}; light {} alone", picture.irradiance.provenance,
                                  scene.world->world->lights.sources[i]);
    each.lens = picture.irradiance.lens;
  }
}

int samples_asked(const PreparedScene& scene) {
  const RenderRequest& request = scene.request;
  return request.samples_per_pixel.value_or(request.noise > 0 ? most_samples_for_noise : usual_samples);
}

Rendering render_scene(const PreparedScene& scene, const Context& context, const PictureWatch& watch) {
  if (scene.wants_autofocus()) {
    PreparedScene focused = scene;
    autofocus(focused, context);
    return render_scene(focused, context, watch);
  }
  const render::World& world = *scene.world->world;
  if (world.is_dark()) send_note(context, "the scene has no lights; the picture will be black");
  render::RenderOptions options = sampling_of(scene, context);
  const int samples = render::effective_samples(world.groups, options.samples_per_pixel);
  if (samples != options.samples_per_pixel)
    send_note(context, fmt::format("{} bands need at least {} samples a pixel",
                                   world.groups.wavelengths_nm().size(), samples));
  const auto show = [&](Rendering picture, bool stopped) {
    add_facts(scene, context, picture);
    watch.show(picture, stopped);
  };
  if (watch.show) options.so_far = [&](Rendering picture) { show(std::move(picture), true); };
  if (watch.show && std::isfinite(watch.every_s)) {
    options.preview = [&](const Rendering& picture) { show(picture, false); };
    options.preview_seconds = watch.every_s;
  }
  Rendering picture = result_within(context, [&](const ProgressCallback& progress) {
    render::SceneCamera camera = scene_camera(scene);
    // Where lamps are seen is known of a camera that stands.
    if (!camera.motion) camera.options.lamps = render::lamps_of(world, camera.world_from_camera);
    options.window = camera.crop;
    return render_picture(world, *camera.make(world.groups), camera.world_from_camera, scene.film, options,
                          progress);
  });
  if (picture.noise && *picture.noise > scene.request.noise)
    send_note(context, fmt::format("the noise is {:.3g} after {} samples a pixel; a larger "
                                   "`samples_per_pixel` would let it fall to {:g}",
                                   *picture.noise, picture.samples_per_pixel, scene.request.noise));
  add_facts(scene, context, picture);
  if (const auto seen = scene.lens ? std::optional(framing(scene)) : std::nullopt;
      seen && lights_too_little(*seen))
    send_note(context, fmt::format("{} lights a circle of {:.3g} mm of a film that is {:.3g} x {:.3g} mm; "
                                   "`film_diagonal_mm` {:.3g} would show that alone",
                                   scene.lens->name, seen->lit_circle_mm, seen->film_width_mm,
                                   seen->film_height_mm, seen->lit_circle_mm));
  return picture;
}

FlareLayers scene_flare(const PreparedScene& scene, const FlareOptions& options, const Context& context) {
  if (!scene.lens)
    throw InputError("ghosts and suns are light that comes through glass; a `lens` would be right");
  const RenderRequest& request = scene.request;
  const render::World& world = *scene.world->world;
  const bool at_front = request.camera_origin == RenderRequest::Origin::front;
  const LensPlace place{scene.world->camera.world_from_camera,
                        at_front ? 0 : scene.lens->total_track_mm() / request.scene_unit_mm,
                        request.scene_unit_mm};
  FlareOptions visible = options;
  std::erase_if(visible.suns, [&](const Sun& sun) {
    return !is_seen(world, place, sun.at(world.groups.wavelengths_nm()));
  });
  if (visible.suns.size() < options.suns.size())
    send_note(context, fmt::format("{} of {} suns stand behind something",
                                   options.suns.size() - visible.suns.size(), options.suns.size()));
  const SensorReflection reflection =
      request.camera.sensor ? reflection_of(*request.camera.sensor) : SensorReflection();
  if (options.scatter) scattering_lens(*scene.lens, options.surfaces_scatter);
  const std::vector<double>& nm = world.groups.wavelengths_nm();
  const double psf_mm = request.diffraction ? render::WaveImage::reach_lambda_n * nm.back() * mm_per_nm *
                                                  first_order(*scene.lens).working_f_number
                                            : 0;
  return flare_layers(
      {*scene.lens, request.camera.losses, Tracer::Clip::apertures, reflection, psf_mm}, scene.film, nm,
      options.seeks() ? lights_seen(world, place, options.search.most) : SourcesFound{}, visible, context);
}

void add_scene_flare(const PreparedScene& scene, const FlareOptions& options, FlareLayers& layers,
                     SpectralImage& light, const Context& context) {
  add_layers(layers, light);
  if (options.scatter)
    add_scatter({*scene.lens, scene.request.camera.losses}, options, layers, light, context);
}

void merge_renderings(const std::vector<std::string>& pieces, const std::string& checkpoint,
                      const Context& context) {
  run_within(context, [&](const ProgressCallback& progress) {
    render::merge_checkpoints(pieces, checkpoint, progress);
  });
}

Rendering render_scene(const RenderRequest& request, const Context& context) {
  return render_scene(prepare_scene(request, context), context);
}

}  // namespace petzval
