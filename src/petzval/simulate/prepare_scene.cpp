// SPDX-License-Identifier: BSD-3-Clause
// A three-dimensional scene and a camera brought together.
#include <fmt/format.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/colour/observer.h>
#include <petzval/render/gltf/gltf_scene.h>
#include <petzval/render/lights/alter_lights.h>
#include <petzval/render/pbrt/entity_maker.h>
#include <petzval/render/pbrt/scene_files.h>
#include <petzval/simulate/camera_in_scene.h>
#include <petzval/simulate/mounting.h>
#include <petzval/simulate/prepared_world.h>
#include <petzval/simulate/scene_depth.h>

#include <cmath>
#include <utility>

namespace petzval {

namespace {

/// 31 bands over the visible, as scenes have them.
std::vector<double> usual_wavelengths_nm() {
  std::vector<double> result;
  for (int nm = 400; nm <= 700; nm += 10) result.push_back(nm);
  return result;
}

bool has_lens(const Camera& camera) {
  return !camera.lens.surfaces.empty();
}

/// Whether the camera focuses by itself, if it has a lens.
bool is_automatic(const RenderRequest& request) {
  return !request.focus_as_in_scene && !request.focus_pixel &&
         request.camera.focus.kind == Focus::Kind::automatic && !request.camera.image_distance_mm;
}

void check(const RenderRequest& request) {
  if (request.pinhole && has_lens(request.camera))
    throw InputError("`pinhole` and `lens` exclude each other");
  if (!(request.scene_unit_mm > 0))
    throw InputError(fmt::format("`scene_unit_mm` {}: the length of a scene's unit in mm is above 0",
                                 request.scene_unit_mm));
  if (request.aperture_diameter_mm && request.camera.f_number)
    throw InputError("`aperture_diameter_mm` and `f_number` both set the stop; one of them would be right");
  if (!std::isfinite(request.scene_time))
    throw InputError(fmt::format("`scene_time` {}: a finite number would be right", request.scene_time));
  if (!(request.light_scale > 0 && std::isfinite(request.light_scale)))
    throw InputError(fmt::format("`light_scale` {}: a factor above 0 would be right", request.light_scale));
  if (request.focus_pixel && request.camera.image_distance_mm)
    throw InputError(
        "`focus_pixel` and `image_distance_mm` both place the sensor; one of them would be right");
  if (!(request.rolling_shutter >= 0 && request.rolling_shutter < 1))
    throw InputError(
        fmt::format("`rolling_shutter` {}: from 0 to below 1 would be right", request.rolling_shutter));
  if (request.rolling_shutter > 0 && !request.camera_move && !request.look_move)
    throw InputError("`rolling_shutter` is for a camera that moves; `camera_move` or `look_move` moves it");
  if (request.is_piece() && request.checkpoint.empty())
    throw InputError("a piece of a picture is its sums; `checkpoint` would name the file that they go into");
  if (request.region && ((*request.region)[2] < 1 || (*request.region)[3] < 1))
    throw InputError("`region` has no pixels; column, row, columns and rows would be right");
  if (!request.autofocus.zones.empty() && !is_automatic(request))
    throw InputError(
        "`zones` are for automatic focus; together with `focus` or `image_distance_mm`, which place the "
        "sensor too, they would have no effect");
}

/// \throws InputError for what an ideal camera has no use for.
void require_no_lens_settings(const RenderRequest& request) {
  const Camera& camera = request.camera;
  const bool focused = !request.focus_as_in_scene && camera.focus.kind != Focus::Kind::automatic;
  const char* const set = camera.image_distance_mm           ? "image_distance_mm"
                          : focused                          ? "focus"
                          : request.focus_pixel              ? "focus_pixel"
                          : request.aperture_diameter_mm     ? "aperture_diameter_mm"
                          : camera.f_number                  ? "f_number"
                          : camera.focus_wavelength_nm       ? "focus_wavelength_nm"
                          : camera.defocus_mm != 0           ? "defocus_mm"
                          : camera.move_lens_mm != 0         ? "move_lens_mm"
                          : camera.blades                    ? "blades"
                          : request.diffraction              ? "diffraction"
                          : camera.losses.any()              ? "losses"
                          : !request.autofocus.zones.empty() ? "zones"
                                                             : nullptr;
  if (set) throw InputError(fmt::format("`{}` belongs to a lens; `lens` names one", set));
}

render::CameraChoice camera_choice(const RenderRequest& request) {
  render::CameraChoice choice;
  if (has_lens(request.camera)) choice.lens = request.camera.lens;
  choice.pinhole = request.pinhole;
  choice.sensor = request.camera.sensor;
  choice.columns = request.columns, choice.rows = request.rows;
  choice.film_diagonal_mm = request.film_diagonal_mm;
  choice.aperture_diameter_mm = request.aperture_diameter_mm;
  choice.scene_stop = !request.camera.f_number;
  choice.options.scene_units_per_mm = 1 / request.scene_unit_mm;
  choice.options.diffraction = request.diffraction;
  choice.options.origin_at_front = request.camera_origin == RenderRequest::Origin::front;
  if (request.sampling == RenderRequest::Sampling::rear_disk)
    choice.options.sampling = render::LensCameraOptions::Sampling::rear_disk;
  choice.options.losses = request.camera.losses;
  return choice;
}

/// Focused as the scene's file says.
void focus_as_scene(const render::SceneFocus& scene, const RenderRequest& request, Camera& camera,
                    const Context& context) {
  camera.focus = scene.distance_m ? Focus::at_m(*scene.distance_m) : Focus::design();
  camera.image_distance_mm = scene.film_distance_mm;
  if (request.focus_as_in_scene && !request.focus_pixel && !scene.distance_m && !scene.film_distance_mm)
    send_note(
        context,
        "the lens is focused as its prescription has it: the scene gives no distance, and `focus` none");
}

Lens lens_as_used(const render::SceneCamera& scene, const RenderRequest& request, const Context& context) {
  Camera camera = request.camera;
  camera.lens = *scene.lens;
  if (camera.image_distance_mm && request.focus_as_in_scene)
    camera.focus = Focus::design();
  else if (request.focus_as_in_scene || request.focus_pixel || is_automatic(request))
    focus_as_scene(scene.focus, request, camera, context);
  const MountedLens mounted = mounted_lens(camera, context);
  FieldTableRequest at = FieldTableRequest::of(mounted.lens());
  const std::vector<double> light =
      request.wavelengths_nm.empty() ? usual_wavelengths_nm() : request.wavelengths_nm;
  if (focusing_wavelength_nm(mounted, light)) at.wavelengths_nm = light;
  Lens lens = focus(mounted, camera.focus, at, context, camera.defocus_mm);
  if (camera.apertures == Camera::Apertures::ignored)
    for (Surface& surface : lens.surfaces)
      if (!surface.stop) surface.semi_diameter_mm.reset();
  camera.losses.validate(lens);
  return lens;
}

void clip(const RenderRequest& request, render::ClippingPlanes& planes) {
  if (request.near_distance) planes.near = *request.near_distance;
  if (request.far_distance) planes.far = *request.far_distance;
  if (!(planes.near < planes.far))
    throw InputError(
        fmt::format("nothing lies between the clipping planes at {:g} and {:g}", planes.near, planes.far));
}

render::PathOptions path_options(const RenderRequest& request, const render::SceneDescription& scene,
                                 render::Unsupported& unsupported) {
  render::PathOptions path;
  const render::Entity& integrator = scene.integrator;
  if (!integrator.type.empty() && integrator.type != "path" && integrator.type != "volpath")
    unsupported.report(integrator.location(), fmt::format("Integrator \"{}\"", integrator.type));
  path.max_depth = integrator.parameters.integer("maxdepth", path.max_depth);
  if (request.max_depth) path.max_depth = *request.max_depth;
  for (const char* ignored : {"lightsampler", "regularize"}) integrator.parameters.find(ignored);
  unsupported.report_unused(integrator.parameters, fmt::format("Integrator \"{}\"", integrator.type));
  return path;
}

/// White light of this luminance from all around. \param light_scale  that all lights are multiplied by.
render::LightDescription white_sky(double cd_m2, double light_scale) {
  render::EntityMaker light("infinite", {std::make_shared<const std::string>("sky"), 0, 0});
  return {light.rgb("L", {1, 1, 1}).number("scale", cd_m2 / lumens_per_watt / light_scale).made(), {}};
}

render::SceneDescription read_description(const std::string& name, double time,
                                          render::Unsupported& unsupported) {
  const std::string path = find_data_file("scenes", ".pbrt", name, "three-dimensional scene");
  return render::has_gltf_name(path) ? render::read_gltf_scene(path, unsupported)
                                     : render::read_scene_description(path, unsupported, time);
}

std::vector<double> wavelengths_of(const RenderRequest& request) {
  return request.wavelengths_nm.empty() ? usual_wavelengths_nm() : request.wavelengths_nm;
}

/// Whether one world serves both.
bool same_world(const RenderRequest& a, const RenderRequest& b) {
  return a.scene == b.scene && a.scene_time == b.scene_time && a.absolute_spectra == b.absolute_spectra &&
         a.light_scale == b.light_scale && a.light_changes == b.light_changes && a.sky_cd_m2 == b.sky_cd_m2 &&
         a.skip_unsupported == b.skip_unsupported && wavelengths_of(a) == wavelengths_of(b);
}

void build(const RenderRequest& request, render::Unsupported& unsupported, PreparedWorld& made) {
  made.world = build_world_at(*made.description, request, wavelengths_of(request), unsupported);
  made.for_focus = std::make_shared<WorldForFocus>();
}

/// What the pixel sees is sharp.
void focus_on_pixel(const Context& context, PreparedScene& scene) {
  RenderRequest sharp = scene.request;
  sharp.camera.focus = Focus::at_m(depth_of_pixel_m(scene, *scene.request.focus_pixel));
  sharp.focus_as_in_scene = false;
  sharp.focus_pixel.reset();
  scene.lens = lens_as_used(scene.world->camera, sharp, context);
}

/// \param before  whose world is kept if it serves; may be null.
PreparedScene prepare(const RenderRequest& request, const PreparedScene* before, const Context& context,
                      render::Unsupported& unsupported) {
  check(request);
  auto made = std::make_shared<PreparedWorld>();
  const bool kept = before && same_world(request, before->request);
  if (kept) {
    *made = *before->world;
  } else {
    render::SceneDescription description = read_description(request.scene, request.scene_time, unsupported);
    render::alter_lights(request.light_changes, description);
    if (request.sky_cd_m2) description.lights.push_back(white_sky(*request.sky_cd_m2, request.light_scale));
    made->description = std::make_shared<const render::SceneDescription>(std::move(description));
  }
  made->camera = render::set_up_camera(*made->description, camera_choice(request), unsupported);
  if (!kept)
    for (const std::string& line : made->description->notes) send_note(context, line);
  for (const std::string& line : made->camera.notes) send_note(context, line);
  PreparedScene scene{request, made->camera.film, made->camera.photosite, {}, {}, {}, {}};
  if (made->camera.lens)
    scene.lens = lens_as_used(made->camera, request, context);
  else
    require_no_lens_settings(request);
  clip(request, made->camera.clipping);
  made->path = path_options(request, *made->description, unsupported);
  if (!kept) build(request, unsupported, *made);
  place_camera(request, scene.lens, *made, context);
  scene.files = render::scene_files(*made->description);
  scene.world = std::move(made);
  if (request.focus_pixel) focus_on_pixel(context, scene);
  return scene;
}

}  // namespace

bool PreparedScene::wants_autofocus() const {
  return lens && !focus && is_automatic(request);
}

double PreparedScene::film_distance_mm() const {
  return lens ? lens->image_distance_mm() : 0;
}

std::string camera_text(const PreparedScene& scene) {
  if (!scene.lens)
    return scene.world->camera.perspective.lens_radius > 0 ? "thin lens (irradiance as radiance times 1 sr)"
                                                           : "pinhole (irradiance as radiance times 1 sr)";
  return fmt::format("{}, film {:.6g} mm behind the last surface, stop {:.4g} mm wide", scene.lens->name,
                     scene.film_distance_mm(), 2 * stop_radius_mm(*scene.lens));
}

std::unique_ptr<const render::World> build_world_at(const render::SceneDescription& description,
                                                    const RenderRequest& request,
                                                    const std::vector<double>& wavelengths_nm,
                                                    render::Unsupported& unsupported) {
  return render::build_world(description, render::WavelengthGroups(wavelengths_nm),
                             {request.absolute_spectra, request.light_scale}, unsupported);
}

render::SceneCamera scene_camera(const PreparedScene& scene) {
  render::SceneCamera camera = scene.world->camera;
  camera.lens = scene.lens;
  return camera;
}

render::RenderOptions render_options(const PreparedScene& scene) {
  render::RenderOptions options;
  options.path = scene.world->path;
  options.photosite = scene.photosite;
  options.clipping = scene.world->camera.clipping;
  return options;
}

PreparedScene prepare_scene(const RenderRequest& request, const Context& context) {
  return result_within(context, [&](const ProgressCallback&) {
    render::Unsupported unsupported(request.skip_unsupported);
    PreparedScene scene = prepare(request, nullptr, context, unsupported);
    if (const std::size_t count = unsupported.list().size(); count > 0)
      send_note(context,
                fmt::format("{} of the scene's features are left out; `list_unsupported` shows them", count));
    return scene;
  });
}

PreparedScene prepare_scene(const RenderRequest& request, const PreparedScene& before,
                            const Context& context) {
  if (!same_world(request, before.request)) return prepare_scene(request, context);
  return result_within(context, [&](const ProgressCallback&) {
    render::Unsupported unsupported(true);  // what it finds has been reported
    return prepare(request, &before, context, unsupported);
  });
}

std::vector<UnsupportedFeature> unsupported_features(RenderRequest request, const Context& context) {
  request.wavelengths_nm = {550};
  Context silent = context;
  silent.note = {};
  return result_within(context, [&](const ProgressCallback&) {
    render::Unsupported unsupported(true);
    prepare(request, nullptr, silent, unsupported);
    std::vector<UnsupportedFeature> features;
    for (const render::Complaint& each : unsupported.list())
      features.push_back({each.at.file ? *each.at.file : "", each.at.line, each.at.column,
                          each.at.path ? std::optional(*each.at.path) : std::nullopt, each.at.text(),
                          each.what});
    return features;
  });
}

}  // namespace petzval
