// SPDX-License-Identifier: BSD-3-Clause
// A scene and a camera brought together: distance, focus, table, frame.
#include <fmt/format.h>
#include <petzval/analysis/field_tracer.h>
#include <petzval/analysis/field_values.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/imaging/depth_field.h>
#include <petzval/imaging/field_of_view.h>
#include <petzval/imaging/image_table.h>
#include <petzval/lens/lens_file.h>
#include <petzval/lens/ray_transfer.h>
#include <petzval/optics/build.h>
#include <petzval/scene/depth_map.h>
#include <petzval/simulate/asked_of_table.h>
#include <petzval/simulate/image.h>
#include <petzval/simulate/imaging_memory.h>
#include <petzval/simulate/lens_on_sensor.h>
#include <petzval/simulate/mounting.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

namespace petzval {

namespace {

/// How many fields and wavelengths a lens's table has: what a picture needs, or what tells how far light
/// spreads, to a per cent of the field.
enum class TableDetail { full, outline };

/// To be read, or in memory.
using SceneInput = std::variant<const SceneRequest*, Scene>;

const std::optional<Sensor>& sensor_of(const Optics& optics) {
  return std::visit([](const auto& camera) -> const std::optional<Sensor>& { return camera.sensor; }, optics);
}

/// Whether a scene takes any angle and distance: a chart or a photograph on a plane.
bool is_open(const SceneRequest& scene) {
  return !scene.options.panorama && is_open_scene(scene.name);
}

/// Whether somebody says how wide it is.
bool has_width(const SceneRequest& scene) {
  return scene.options.horizontal_angle_deg || scene.options.width_m;
}

Scene read(const SceneRequest& asked, std::optional<double> expected_m, bool expected, const Context& context,
           ImagingMemory* memory) {
  SceneRequest request = asked;
  SceneOptions& options = request.options;
  // Where a chart or a photograph stands if nobody says: where the lens or its table expects the object.
  const bool placed = is_deep_chart(request.name) || is_drawn_to_angle(request.name, {});
  if (expected && !options.distance_m && is_open(request) && !placed && (expected_m || !options.tilt_deg))
    options.distance_m = expected_m.value_or(INFINITY);
  const auto from_file = [&] {
    Scene scene = read_scene(request.name, options);
    scene.validate();
    return scene;
  };
  Scene scene = memory != nullptr ? memory->scene(request, from_file) : from_file();
  for (const std::string& text : scene.notes) send_note(context, fmt::format("{}: {}", request.name, text));
  return scene;
}

/// Without a sensor whose frame it would fill, a photograph is as wide as the fields of the lens.
SceneRequest as_wide_as_fields(SceneRequest request, const Camera& camera) {
  constexpr double across = 0.8;  // of the diagonal
  const double view_deg = first_order(camera.lens).field_of_view_deg;
  if (camera.sensor || !is_open(request) || has_width(request)) return request;
  if (view_deg > 0 && view_deg < 170)
    request.options.horizontal_angle_deg = 2 * degrees(std::atan(across * std::tan(radians(view_deg) / 2)));
  return request;
}

/// How far from the axis the fields of a lens are imaged, but for what is too far aside for a plane scene; 0:
/// nobody says.
double fields_image_height_mm(const Lens& lens) {
  constexpr double widest_deg = 75;
  double height_mm = 0;
  FieldTracer tracer(lens, lens.reference_wavelength_nm);
  for (const double value : lens.fields.values) {
    double field = object_field(lens, lens.fields.kind, value);
    if (!lens.object_distance_mm) field = std::clamp(field, -widest_deg, widest_deg);
    if (const auto chief = tracer.chief_ray(field))
      height_mm = std::max(height_mm, std::hypot(chief->image_x_mm, chief->image_height_mm));
  }
  return height_mm;
}

/// Where a chart is imaged if nobody says: on 640 × 480 pixels whose corner lies near the end of the lens's
/// fields.
std::optional<Sensor> frame_of_fields(const SceneRequest& request, const Camera& camera) {
  if (camera.sensor || !is_open(request) || has_width(request) || !is_builtin_scene(request.name) ||
      is_deep_chart(request.name))
    return camera.sensor;
  constexpr int columns = 640, rows = 480;
  const double height_mm = fields_image_height_mm(camera.lens);
  if (!(height_mm > 0)) return {};
  // Beyond its fields a lens may pass but a sliver of light, spread over millimetres: what PSFs bring into
  // the corner comes from within them.
  constexpr double share = 0.95;
  return read_sensor(fmt::format("{}x{}@{:.4g}", columns, rows,
                                 2 * share * height_mm * um_per_mm / std::hypot(columns, rows)));
}

Optics with_frame(const SceneRequest& request, Optics optics) {
  if (auto* const camera = std::get_if<Camera>(&optics)) camera->sensor = frame_of_fields(request, *camera);
  return optics;
}

std::optional<double> middle_from_sensor_m(const Scene& scene, MountedLens& lens) {
  const double depth_m = middle_depth_m(scene);
  if (std::isinf(depth_m)) return std::nullopt;
  if (scene.depth_from == DepthFrom::sensor) return depth_m;
  // The pupil stays as far from the lens as it is; the sensor moves by less and less.
  double focus_m = depth_m;
  constexpr int rounds = 4;
  for (int round = 0; round < rounds; ++round) {
    focus_m = depth_m + DefocusLaw(lens.lens()).pupil_to_sensor_mm() / mm_per_m;
    lens.focus_at_m(focus_m);
  }
  return focus_m;
}

/// Where automatic focus finds a scene with depth: in the middle of the picture, from the sensor plane
/// (absent: infinity).
std::optional<double> depth_focus_m(const Scene& scene, MountedLens lens) {
  try {
    const std::optional<double> middle_m = middle_from_sensor_m(scene, lens);
    lens.focus_at_m(middle_m);
    return middle_m;
  } catch (const InputError& error) {
    throw InputError(
        fmt::format("the depth in the middle of the picture is {:.4g} m: {} (`focus` takes another "
                    "distance; `scene.depth_scale` is for maps in other units than metres)",
                    middle_depth_m(scene), error.what()));
  }
}

/// What a scene with depth is focused on: the object of the lens, though each layer will have its own.
std::optional<double> object_in_focus_m(const Focus& focus, const Scene& scene, const MountedLens& lens) {
  if (focus.kind == Focus::Kind::automatic) return depth_focus_m(scene, lens);
  const std::optional<double> asked_m = asked_distance_m(focus);
  if (!asked_m) return lens.object_distance_from_sensor_m();
  return std::isinf(*asked_m) ? std::nullopt : asked_m;
}

/// Fields and wavelengths that best focus is sought over: the lens's own, unless the light is another.
FieldTableRequest fields_in(const MountedLens& lens, const std::vector<double>& light_nm) {
  FieldTableRequest at = FieldTableRequest::of(lens.lens());
  if (focusing_wavelength_nm(lens, light_nm)) at.wavelengths_nm = light_nm;
  return at;
}

/// The lens as it is used: focused as asked, the object where the scene is.
Lens focused_on(MountedLens lens, const Camera& camera, std::optional<double> scene_distance_m,
                const std::vector<double>& light_nm, const Context& context) {
  lens.set_focus_wavelength_nm(focusing_wavelength_nm(lens, light_nm));
  if (camera.focus.kind == Focus::Kind::automatic && !camera.image_distance_mm) {
    MountedLens focused = lens;
    focused.focus_at_m(scene_distance_m);
    note_colour_shift(focused, context);
    if (camera.defocus_mm != 0) focused.move_sensor_mm(camera.defocus_mm);
    return focused.lens();
  }
  MountedLens start = lens;
  if (camera.focus.sought() && !asked_distance_m(camera.focus)) start.focus_at_m(scene_distance_m);
  MountedLens here(focus(start, camera.focus, fields_in(lens, light_nm), context, camera.defocus_mm));
  // The sensor stays; only the object moves.
  if (here.object_distance_from_sensor_m() != scene_distance_m) here.place_object_at_m(scene_distance_m);
  return here.lens();
}

/// Of the sensor, or of the frame that will follow the scene.
double pixel_um(const Scene& scene, const Lens& lens, const std::optional<Sensor>& sensor) {
  if (sensor) return sensor->geometry.pitch_um;
  return scene.depth_m.empty() ? natural_pitch_um(scene, first_order(lens))
                               : natural_depth_pitch_um(scene, lens);
}

/// How far from the axis light will be wanted: to the sensor's corner, or to that of the scene's image, and a
/// little beyond, from where PSFs spread into the corner.
double image_height_mm(const Scene& scene, double pitch_um, const std::optional<Sensor>& sensor) {
  const double half_diagonal_mm = sensor
                                      ? sensor->geometry.half_diagonal_mm()
                                      : pitch_um * mm_per_um * std::hypot(scene.columns(), scene.rows()) / 2;
  return half_diagonal_mm + beyond_frame_mm(half_diagonal_mm, pitch_um);
}

/// Every `step`th of the wavelengths, and the last.
std::vector<double> thinned(const std::vector<double>& wavelengths_nm, std::size_t step) {
  std::vector<double> few;
  for (std::size_t i = 0; i < wavelengths_nm.size(); i += step) few.push_back(wavelengths_nm[i]);
  if (few.back() != wavelengths_nm.back()) few.push_back(wavelengths_nm.back());
  return few;
}

TableOptions table_options(const Camera& camera, const Scene& scene, TableDetail detail) {
  TableOptions options;
  options.wavelengths_nm = scene.wavelengths_nm();
  if (detail == TableDetail::outline) {
    constexpr std::size_t step = 5;
    options.wavelengths_nm = thinned(options.wavelengths_nm, step);
    options.field_count = 11;
    options.frame_places = 7;
  }
  if (camera.apertures == Camera::Apertures::ignored) options.clip = Tracer::Clip::stop_only;
  options.losses = camera.losses;
  return options;
}

/// A table of nothing but the lens's name and paraxial optics.
LensDataTable facts_alone(const Lens& lens) {
  LensDataTable table;
  table.lens_name = lens.name;
  table.first_order = first_order(lens);
  return table;
}

/// All that a table is made of; empty for coatings, which have no text.
std::string lens_key(const Lens& lens, const TableOptions& options, double pitch_um, double contrast = 1) {
  const Losses& losses = options.losses;
  if (losses.air_glass || !losses.surfaces.empty()) return {};
  std::string key = fmt::format("{} {} {} {} {} {} {} {} {}", pitch_um, contrast, options.max_image_height_mm,
                                options.field_count, options.frame_places, static_cast<int>(options.clip),
                                losses.fresnel, losses.absorption, lens_to_json(lens));
  for (const double nm : options.wavelengths_nm) key += fmt::format(" {}", nm);
  if (options.half_frame_mm)
    key += fmt::format(" {} {}", (*options.half_frame_mm)[0], (*options.half_frame_mm)[1]);
  return key;
}

LitLens in_use(const Lens& focused, const TableOptions& table, const Camera& camera) {
  return {focused, table.losses, table.clip,
          camera.sensor ? reflection_of(*camera.sensor) : SensorReflection()};
}

/// What ghosts need, before the long work. \throws InputError saying what is missing.
void check_flare(const ImagePlan& plan) {
  const FlareOptions& options = plan.options.flare;
  if (!options.any()) return;
  options.search.validate();
  if (!plan.lens)
    throw InputError(
        "a lens data table does not say what its surfaces reflect; a `lens` would be right for ghosts and "
        "suns");
  require_glass(plan.lens->lens, "ghosts and suns need");
  require_no_bends(plan.lens->lens, "ghosts and suns need");
  if (options.scatter) scattering_lens(plan.lens->lens, options.surfaces_scatter);
  for (const Sun& sun : options.suns) sun.at(plan.scene.wavelengths_nm());
  if (plan.depth)
    throw InputError(
        "ghosts and suns are for scenes on a plane or all around; this one has depth (`scene.depth` none "
        "takes it away)");
}

/// Whether a chart stands where the lens has its object: a lens that stays as it is, or one of next to no
/// power, which images nothing that is far away.
bool expects_object(const Camera& camera) {
  const bool nearby = camera.focus.kind == Focus::Kind::automatic && camera.lens.object_distance_mm;
  return camera.focus.kind == Focus::Kind::design || (nearby && is_afocal(first_order(camera.lens)));
}

/// Scene and table, before frame and scene are fitted to each other.
ImagePlan source(SceneInput input, const Camera& camera, ImageOptions options, TableDetail detail,
                 const Context& context, ImagingMemory* memory) {
  const MountedLens lens = mounted_lens(camera, context);
  Scene scene = std::holds_alternative<Scene>(input)
                    ? std::get<Scene>(std::move(input))
                    : read(as_wide_as_fields(*std::get<const SceneRequest*>(input), camera),
                           lens.object_distance_from_sensor_m(), expects_object(camera), context, memory);
  const bool deep = !scene.depth_m.empty();
  if (scene.distance_m() && !deep) {
    MountedLens placed = lens;
    placed.place_object_at_m(scene.distance_m());
    if (!placed.lens().object_distance_mm) scene.set_distance_m({});  // so far away that this is infinity
  }
  const Lens focused =
      focused_on(lens, camera, deep ? object_in_focus_m(camera.focus, scene, lens) : scene.distance_m(),
                 scene.wavelengths_nm(), context);
  if (camera.sensor && detail == TableDetail::full)
    note_short_field(focused, camera.sensor->geometry, context);
  TableOptions table = table_options(camera, scene, detail);
  const double pitch_um = pixel_um(scene, focused, camera.sensor);
  table.max_image_height_mm = image_height_mm(scene, pitch_um, camera.sensor);
  if (camera.sensor) table.half_frame_mm = half_frame_mm(camera.sensor->geometry);
  if (deep && memory != nullptr) memory->set_lens_key(lens_key(focused, table, pitch_um));
  if (deep)
    return {std::move(scene),
            facts_alone(focused),
            DepthCamera{focused, table, std::make_shared<std::map<std::string, LensDataTable>>()},
            {},
            std::move(options),
            in_use(focused, table, camera)};
  const bool says_spread = mixes_psfs(options) && detail != TableDetail::outline;
  SpreadWanted wanted;
  if (says_spread) wanted = spread_wanted(options, pitch_um, scene, first_order(focused));
  const auto build = [&] {
    return result_within(context, [&](const ProgressCallback& progress) {
      return says_spread ? build_image_table(focused, table, wanted, progress)
                         : build_lens_data_table(focused, table, progress);
    });
  };
  LensDataTable built =
      memory != nullptr ? memory->table(lens_key(focused, table, pitch_um, wanted.contrast), build) : build();
  return {std::move(scene), std::move(built), {}, {}, std::move(options), in_use(focused, table, camera)};
}

/// A stored table is what it is: the scene stands where it was made for.
ImagePlan source(SceneInput input, TableCamera& camera, ImageOptions options, TableDetail detail,
                 const Context& context, ImagingMemory* memory) {
  if (memory != nullptr) memory->set_lens_key({});
  std::optional<double> distance_m;
  if (const std::optional<double> distance_mm = object_to_sensor_mm(camera.table))
    distance_m = *distance_mm / mm_per_m;
  Scene scene = std::holds_alternative<Scene>(input)
                    ? std::get<Scene>(std::move(input))
                    : read(*std::get<const SceneRequest*>(input), distance_m, true, context, memory);
  if (!scene.depth_m.empty())
    send_note(
        context,
        "the scene's depth map is not used: a lens data table is made for one distance; `lens` would use it");
  if (detail == TableDetail::full && camera.table.interpolation_error == 0)
    camera.table.interpolation_error = stored_table_error(camera, scene, options);
  return {std::move(scene), std::move(camera.table), {}, {}, std::move(options), {}};
}

double filling_angle_deg(const ImagePlan& plan, const SensorGeometry& sensor) {
  const ImagingOptions& options = plan.options.imaging;
  return plan.depth ? covering_depth_angle_deg(plan.scene, *plan.depth, sensor, options, plan.options.depth)
                    : covering_angle_deg(plan.scene, plan.table, sensor, options);
}

/// A chart or a photograph without an angle of its own fills the frame; without a sensor the frame follows
/// the scene.
void fit_to_each_other(ImagePlan& plan, const Optics& optics, const SceneRequest* request,
                       const Context& context, ImagingMemory* memory) {
  const std::optional<Sensor>& sensor = sensor_of(optics);
  if (!sensor) {
    plan.frame = plan.depth
                     ? natural_depth_sensor(plan.scene, *plan.depth, plan.options.imaging, plan.options.depth)
                     : natural_sensor(plan.scene, plan.table, plan.options.imaging);
    return send_note(
        context,
        fmt::format("no `sensor`: {} x {} pixels of {:.5g} um, the scene's samples as the lens images "
                    "them on the axis, as many as the scene covers",
                    plan.frame.columns, plan.frame.rows, plan.frame.pitch_um));
  }
  plan.frame = sensor->geometry;
  if (!request || !is_open(*request) || has_width(*request)) return;
  const double fills_deg = filling_angle_deg(plan, plan.frame);
  const double angle_deg = std::max(fills_deg, plan.options.least_scene_angle_deg.value_or(0));
  if (!is_drawn_to_angle(request->name, request->options))
    return plan.scene.set_horizontal_angle_deg(angle_deg);
  SceneRequest drawn = *request;
  drawn.options.horizontal_angle_deg = angle_deg;
  const std::optional<double> distance_m = plan.scene.distance_m();
  if (memory != nullptr) memory->give_back(plan.scene);
  plan.scene = read(drawn, distance_m, true, context, memory);
}

ImageOptions with_photosite(ImageOptions options, const Optics& optics) {
  if (const std::optional<Sensor>& sensor = sensor_of(optics)) options.imaging.photosite = sensor->photosite;
  options.imaging.validate();
  options.depth.validate();
  return options;
}

ImagePlan plan(SceneInput input, Optics optics, const ImageOptions& options, const Context& context,
               ImagingMemory* memory = nullptr) {
  const SceneRequest* const request =
      std::holds_alternative<Scene>(input) ? nullptr : std::get<const SceneRequest*>(input);
  if (options.least_scene_angle_deg && !(request && fills_frame(*request, optics, options)))
    throw InputError(
        "`least_scene_angle_deg` is for a chart or a photograph that fills the frame of a `sensor`; "
        "`scene.horizontal_angle_deg` would be right");
  if (request) optics = with_frame(*request, std::move(optics));
  const ImageOptions wanted = with_photosite(options, optics);
  ImagePlan result = std::visit(
      [&](auto& camera) {
        return source(std::move(input), camera, wanted, TableDetail::full, context, memory);
      },
      optics);
  check_flare(result);
  if (!result.depth && wanted.depth.layers != 0)
    throw InputError("`layers` is for scenes with depth; this one is a plane (`scene.depth` gives it a map)");
  run_within(context,
             [&](const ProgressCallback&) { fit_to_each_other(result, optics, request, context, memory); });
  if (memory != nullptr) result.memory = memory->formation();
  return result;
}

}  // namespace

ImagePlan plan_image(const SceneRequest& scene, Optics optics, const ImageOptions& options,
                     const Context& context) {
  return plan(&scene, std::move(optics), options, context);
}

ImagePlan plan_image(Scene scene, Optics optics, const ImageOptions& options, const Context& context) {
  scene.validate();
  return plan(std::move(scene), std::move(optics), options, context);
}

ImagePlan plan_image(const SceneRequest& scene, Optics optics, const ImageOptions& options,
                     const Context& context, ImagingMemory& memory) {
  return plan(&scene, std::move(optics), options, context, &memory);
}

ImagePlan plan_image(Scene scene, Optics optics, const ImageOptions& options, const Context& context,
                     ImagingMemory& memory) {
  scene.validate();
  return plan(std::move(scene), std::move(optics), options, context, &memory);
}

bool fills_frame(const SceneRequest& scene, const Optics& optics, const ImageOptions& options) {
  return is_open(scene) && !has_width(scene) && options.imaging.surround == Surround::error &&
         sensor_of(with_frame(scene, optics));
}

std::optional<double> filling_angle_deg(const SceneRequest& scene, const Optics& optics,
                                        const ImageOptions& options, const Context& context) {
  if (!fills_frame(scene, optics, options)) return {};
  Optics framed = with_frame(scene, optics);
  const ImageOptions wanted = with_photosite(options, framed);
  return result_within(context, [&](const ProgressCallback&) {
    const ImagePlan outline = std::visit(
        [&](auto& camera) { return source(&scene, camera, wanted, TableDetail::outline, context, nullptr); },
        framed);
    return filling_angle_deg(outline, sensor_of(framed)->geometry);
  });
}

}  // namespace petzval
