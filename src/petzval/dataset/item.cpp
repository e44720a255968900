// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/isolated.h>
#include <petzval/base/scratch_folder.h>
#include <petzval/base/whole_file.h>
#include <petzval/dataset/flat_truth.h>
#include <petzval/dataset/item.h>
#include <petzval/dataset/object_masks.h>
#include <petzval/dataset/pixel_psfs.h>
#include <petzval/image/formats/npy.h>
#include <petzval/lens/first_order.h>
#include <petzval/lens/lens_file.h>
#include <petzval/lens/lens_states.h>
#include <petzval/numeric/random.h>
#include <petzval/sensor/formats/dng.h>
#include <petzval/simulate/develop.h>
#include <petzval/simulate/expose.h>
#include <petzval/simulate/image.h>
#include <petzval/simulate/scene_truth.h>
#include <petzval/tolerance/tolerancing.h>

#include <cmath>
#include <filesystem>

namespace petzval {

namespace {

using nlohmann::json;

/// Purpose of the seed of an item's noise.
constexpr std::uint32_t noise_purpose = 0x44534eff;
/// What is left out of pictures and electrons without noise: what light does not do.
const std::set<NoiseSource> all_noise = {NoiseSource::shot, NoiseSource::dark,   NoiseSource::read,
                                         NoiseSource::dsnu, NoiseSource::prnu,   NoiseSource::column,
                                         NoiseSource::row,  NoiseSource::defects};

/// The drawn values of one item.
class Draw {
 public:
  Draw(const Recipe& recipe, std::size_t item) : values_(draw_item(recipe, item)), folder_(recipe.folder) {}

  std::optional<double> number(const char* name) const {
    const auto found = values_.find(name);
    return found == values_.end() ? std::nullopt : std::optional(std::get<double>(found->second));
  }
  double number(const char* name, double otherwise) const { return number(name).value_or(otherwise); }
  std::string text(const char* name) const {
    const auto found = values_.find(name);
    return found == values_.end() ? std::string() : std::get<std::string>(found->second);
  }
  /// A file's name from the folder of the recipe, if there is such a file; else what was drawn.
  std::string file(const char* name) const {
    const std::string drawn = text(name), there = (std::filesystem::path(folder_) / drawn).string();
    std::error_code failed;
    return !drawn.empty() && std::filesystem::is_regular_file(there, failed) ? there : drawn;
  }
  std::optional<std::array<double, 3>> place(const std::string& name) const {
    const auto x = number((name + "_x").c_str());
    if (!x) return {};
    return std::array<double, 3>{*x, *number((name + "_y").c_str()), *number((name + "_z").c_str())};
  }
  std::vector<render::LightChange> lights() const {
    std::vector<render::LightChange> changes;
    for (const auto& [name, value] : values_)
      if (const auto light = light_parameter(name))
        changes.push_back(
            {static_cast<render::LightChange::Kind>(light->kind), light->light, std::get<double>(value)});
    return changes;
  }
  json facts() const {
    json all = json::object();
    for (const auto& [name, value] : values_)
      std::visit([&, &key = name](const auto& each) { all[key] = each; }, value);
    return all;
  }

 private:
  std::map<std::string, ParameterValue> values_;
  std::string folder_;
};

/// Writes a file by its extension, and takes its bytes.
template <typename Write>
ItemFile file_of(const ScratchFolder& scratch, const std::string& extension, const Write& write) {
  const std::string path = scratch.path() + "/item." + extension;
  write(path);
  ItemFile file{extension, read_whole_file(path)};
  std::filesystem::remove(path);
  return file;
}

ItemFile npy_of(const ScratchFolder& scratch, const std::string& extension, std::vector<std::size_t> shape,
                std::span<const float> values) {
  return file_of(scratch, extension, [&](const std::string& path) { write_npy(path, shape, values); });
}

Camera camera_of(const Draw& draw, const Recipe& recipe) {
  Camera camera;
  camera.lens = read_lens(draw.file("lens")).lens;
  if (const std::string state = draw.text("state"); !state.empty())
    camera.lens = in_state(camera.lens, state);
  if (const auto state = draw.number("state_number")) camera.lens = in_state(camera.lens, *state);
  if (const auto build = draw.number("build")) {
    ToleranceRequest tolerances{.tolerances = recipe.build_tolerances};
    if (const std::string grade = draw.text("grade"); !grade.empty()) tolerances.grade = grade;
    camera.lens = build_off_the_line(camera.lens, tolerances, recipe.seed, static_cast<std::size_t>(*build));
  }
  camera.f_number = draw.number("f_number");
  if (const auto stops = draw.number("stop_down_ev"))
    camera.f_number = first_order(camera.lens).f_number * std::exp2(*stops / 2);
  if (const std::string focus = draw.text("focus"); !focus.empty()) camera.focus = Focus::parse(focus);
  if (const auto distance_m = draw.number("focus_distance_m")) camera.focus = Focus::at_m(*distance_m);
  camera.defocus_mm = draw.number("defocus_mm", 0);
  camera.sensor = read_sensor(draw.file("sensor"), recipe.sensor_settings);
  camera.sensor->require_electronics();
  return camera;
}

ExposeOptions exposure_of(const Draw& draw) {
  ExposeOptions options;
  if (const auto seconds = draw.number("exposure_s")) options.exposure = Exposure::seconds(*seconds);
  options.compensation_ev = draw.number("exposure_compensation_ev", 0);
  options.analog_gain = draw.number("analog_gain", 1);
  if (const auto serial = draw.number("sensor_serial")) options.serial = static_cast<std::uint64_t>(*serial);
  return options;
}

Development development_of(const Draw& draw) {
  Development development;
  if (const std::string white = draw.text("white_balance"); !white.empty())
    development.white_balance = WhiteBalance::parse(white);
  development.options.exposure_ev = draw.number("brightness_ev", 0);
  return development;
}

json intrinsics_json(const Intrinsics& fit) {
  return {{"model", fit.fisheye ? "opencv-fisheye" : "opencv"},
          {"fx_px", fit.focal_px},
          {"fy_px", fit.focal_px},
          {"cx_px", fit.centre_x},
          {"cy_px", fit.centre_y},
          {"radial", fit.radial},
          {"rms_px", fit.rms_px},
          {"worst_px", fit.worst_px}};
}

/// One item on its way.
class ItemInMaking {
 public:
  ItemInMaking(const Recipe& recipe, std::size_t number) : recipe_(recipe), draw_(recipe, number) {
    context_.seed = RandomStream(recipe.seed, noise_purpose, number).bits();
    context_.note = [this](const std::string& text) { notes_.push_back(text); };
    item_.facts = {{"item", number}, {"key", ItemMaker::key(number)}, {"parameters", draw_.facts()}};
  }
  ItemInMaking(const ItemInMaking&) = delete;
  ItemInMaking& operator=(const ItemInMaking&) = delete;

  const Draw& draw() const { return draw_; }
  const Context& context() const { return context_; }

  void image_flat() {
    const Camera camera = camera_of(draw_, recipe_);
    SceneRequest scene{.name = draw_.file("scene")};
    scene.options.wavelengths_nm = recipe_.wavelengths_nm;
    scene.options.distance_m = draw_.number("scene_distance_m");
    scene.options.horizontal_angle_deg = draw_.number("scene_angle_deg");
    scene.options.mean_luminance_cd_m2 = draw_.number("luminance_cd_m2");
    scene.options.illuminant = draw_.text("illuminant");
    ImageOptions options;
    options.imaging.product.tolerance = recipe_.tolerance;
    ImagePlan plan = plan_image(scene, camera, options, context_);
    ImageReport report;
    const SpectralImage light = image(plan, context_, &report);
    tell_lens(plan.table.first_order);
    const double exposure_s = shoot(light, *camera.sensor);
    // Layers have tables of their own; rays and PSFs are those of what is in focus.
    if (plan.depth && (recipe_.has(Truth::psf) || recipe_.has(Truth::rays) || recipe_.has(Truth::depth)))
      plan.table = build_lens_data_table(plan.depth->lens, plan.depth->table);
    add_rays_and_depths(plan, report);
    const std::vector<double>& wavelengths_nm = plan.scene.wavelengths_nm();
    if (recipe_.has(Truth::psf))
      add_psfs(pixel_psfs(plan.table, plan.frame, wavelengths_nm, recipe_.psf_rows, recipe_.psf_columns,
                          recipe_.psf_size, context_),
               wavelengths_nm.size());
    if (recipe_.has(Truth::sharp)) {
      plan.options.imaging.method = BlurMethod::none;
      add_sharp(image(plan, context_), *camera.sensor, exposure_s);
    }
  }

  RenderRequest request() const {
    RenderRequest request{.scene = draw_.file("world")};
    request.camera = camera_of(draw_, recipe_);
    request.focus_as_in_scene = draw_.text("focus").empty() && !draw_.number("focus_distance_m");
    request.wavelengths_nm = recipe_.wavelengths_nm;
    request.camera_at = draw_.place("camera");
    request.look_at = draw_.place("look");
    request.camera_move = draw_.place("camera_move");
    request.look_move = draw_.place("look_move");
    request.rolling_shutter = draw_.number("rolling_shutter", 0);
    request.light_scale = draw_.number("light_scale", 1);
    request.light_changes = draw_.lights();
    request.samples_per_pixel = recipe_.samples_per_pixel;
    request.denoise_light = recipe_.denoise_light;
    request.first_surfaces =
        recipe_.has(Truth::depth) || recipe_.has(Truth::normals) || recipe_.has(Truth::albedo);
    return request;
  }

  void render(const PreparedScene& scene) {
    const Rendering rendering = render_scene(scene, context_);
    if (scene.lens) tell_lens(first_order(*scene.lens));
    if (rendering.denoised) item_.facts["denoised"] = true;
    const double exposure_s = shoot(rendering.irradiance, *scene.request.camera.sensor);
    tell_pose(scene);
    if (recipe_.has(Truth::sharp))
      add_sharp(render_sharp(scene, context_).irradiance, *scene.request.camera.sensor, exposure_s);
    const SensorGeometry& film = scene.film;
    const std::size_t film_rows = static_cast<std::size_t>(film.rows),
                      film_columns = static_cast<std::size_t>(film.columns);
    if (recipe_.has(Truth::rays)) add_rays(rays_seen(scene, context_), film);
    if (recipe_.has(Truth::flow))
      add(npy_of(scratch_, "flow.npy", {film_rows, film_columns, 2}, flow_seen(scene, context_)));
    if (recipe_.has(Truth::masks)) add_masks(object_masks(segments_seen(scene, context_)));
    if (recipe_.has(Truth::psf))
      add_psfs(pixel_psfs(scene, recipe_.psf_rows, recipe_.psf_columns, recipe_.psf_size, context_),
               rendering.irradiance.wavelengths_nm().size());
    if (!rendering.first_surfaces) return;
    const render::FirstSurfaces& first = *rendering.first_surfaces;
    const std::size_t rows = rows_of(rendering.irradiance), columns = columns_of(rendering.irradiance),
                      bands = rendering.irradiance.wavelengths_nm().size();
    if (recipe_.has(Truth::depth)) {
      std::vector<float> depth_m = first.depth;
      for (float& each : depth_m) each *= static_cast<float>(scene.request.scene_unit_mm / 1000);
      add(npy_of(scratch_, "depth.npy", {rows, columns}, depth_m));
    }
    if (recipe_.has(Truth::normals)) add(npy_of(scratch_, "normals.npy", {rows, columns, 3}, first.normal));
    if (recipe_.has(Truth::albedo)) {
      std::vector<float> by_pixel(first.albedo.size());
      for (std::size_t pixel = 0; pixel < rows * columns; ++pixel)
        for (std::size_t band = 0; band < bands; ++band)
          by_pixel[pixel * bands + band] = first.albedo[band * rows * columns + pixel];
      add(npy_of(scratch_, "albedo.npy", {rows, columns, bands}, by_pixel));
    }
  }

  Item finished() {
    item_.facts["notes"] = notes_;
    return std::move(item_);
  }

 private:
  static std::size_t rows_of(const SpectralImage& light) { return static_cast<std::size_t>(light.rows()); }
  static std::size_t columns_of(const SpectralImage& light) {
    return static_cast<std::size_t>(light.columns());
  }

  void add(ItemFile file) { item_.files.push_back(std::move(file)); }

  void tell_lens(const FirstOrder& lens) {
    const auto finite = [](double value) { return std::isfinite(value) ? json(value) : json(nullptr); };
    item_.facts["lens"] = {{"focal_length_mm", finite(lens.efl_mm)},
                           {"f_number", finite(lens.f_number)},
                           {"working_f_number", finite(lens.working_f_number)}};
  }

  /// The picture, and what the sensor has of it. \returns the exposure time.
  double shoot(const SpectralImage& light, const Sensor& sensor) {
    const ExposeOptions options = exposure_of(draw_);
    const RawImage raw = expose(light, sensor, options, context_);
    item_.facts["picture"] = {{"columns", raw.columns},
                              {"rows", raw.rows},
                              {"pitch_um", raw.pitch_um},
                              {"exposure_s", raw.exposure_s},
                              {"iso", raw.iso},
                              {"dn_per_e", raw.dn_per_e},
                              {"black_dn", raw.black_level},
                              {"white_dn", raw.white_level},
                              {"channels", raw.channels},
                              {"wavelengths_nm", light.wavelengths_nm()}};
    add(picture_of("png", raw));
    if (recipe_.has(Truth::raw)) add({"dng", dng_bytes(raw, "the item's raw image")});
    if (recipe_.has(Truth::irradiance))
      add(file_of(scratch_, "irradiance.npy", [&](const std::string& path) { write_npy(path, light); }));
    if (recipe_.has(Truth::electrons)) {
      PhotoCurrent current = photo_current(light, sensor);
      for (float& each : current.e_per_s) each *= static_cast<float>(raw.exposure_s);
      add(npy_of(scratch_, "electrons.npy",
                 {static_cast<std::size_t>(current.rows), static_cast<std::size_t>(current.columns)},
                 current.e_per_s));
    }
    return raw.exposure_s;
  }

  ItemFile picture_of(const std::string& extension, const RawImage& raw) {
    // A DNG rounds what is not an integer; what is developed is what one would read.
    const std::string name = "the item's raw image";
    const RawImage stored = fits_dng(raw) ? parse_dng(dng_bytes(raw, name), name) : raw;
    const Picture picture = develop(stored, development_of(draw_), context_);
    return file_of(scratch_, extension,
                   [&](const std::string& path) { write_picture(path, picture, recipe_.bits); });
  }

  void add_sharp(const SpectralImage& light, const Sensor& sensor, double exposure_s) {
    ExposeOptions options = exposure_of(draw_);
    options.exposure = Exposure::seconds(exposure_s);
    options.compensation_ev = 0;
    options.without = all_noise;
    add(picture_of("sharp.png", expose(light, sensor, options, context_)));
  }

  void add_psfs(const PixelPsfs& grid, std::size_t bands) {
    const auto size = static_cast<std::size_t>(recipe_.psf_size);
    add(npy_of(scratch_, "psf.npy", {grid.rows.size(), grid.columns.size(), bands, size, size}, grid.values));
    item_.facts["psf"] = {{"columns_px", grid.columns}, {"rows_px", grid.rows}};
  }

  void add_rays(const std::vector<float>& rays, const SensorGeometry& frame) {
    add(npy_of(scratch_, "rays.npy",
               {static_cast<std::size_t>(frame.rows), static_cast<std::size_t>(frame.columns), 2}, rays));
    if (const auto fit = fit_intrinsics(rays, frame)) item_.facts["intrinsics"] = intrinsics_json(*fit);
  }

  void add_masks(const ObjectMasks& masks) {
    add(file_of(scratch_, "masks.npy", [&](const std::string& path) {
      write_npy(path,
                std::array{static_cast<std::size_t>(masks.rows), static_cast<std::size_t>(masks.columns),
                           std::size_t{2}},
                masks.values);
    }));
    json& objects = item_.facts["objects"] = json::array();
    for (const SeenObject& each : masks.objects)
      objects.push_back({{"object", each.number},
                         {"placed", each.placed},
                         {"pixels", each.pixels},
                         {"box_px", {each.left, each.top, each.columns, each.rows}}});
  }

  void tell_pose(const PreparedScene& scene) {
    json& camera = item_.facts["camera"];
    camera = {{"scene_unit_mm", scene.request.scene_unit_mm}, {"world_from_camera", camera_pose(scene)}};
    if (scene.request.camera_move || scene.request.look_move)
      camera["world_from_camera_at_end"] = camera_pose(scene, 1);
  }

  void add_rays_and_depths(const ImagePlan& plan, const ImageReport& report) {
    if (!recipe_.has(Truth::rays) && !recipe_.has(Truth::depth)) return;
    const std::vector<float> rays = pixel_rays(plan.table, plan.frame);
    const std::size_t rows = static_cast<std::size_t>(plan.frame.rows),
                      columns = static_cast<std::size_t>(plan.frame.columns);
    if (recipe_.has(Truth::rays)) add_rays(rays, plan.frame);
    if (recipe_.has(Truth::depth))
      add(npy_of(scratch_, "depth.npy", {rows, columns},
                 pixel_depths(plan.scene, rays, report.pupil_to_sensor_mm)));
  }

  const Recipe& recipe_;
  Draw draw_;
  Context context_;
  std::vector<std::string> notes_;
  ScratchFolder scratch_;
  Item item_;
};

}  // namespace

std::string ItemMaker::key(std::size_t item) {
  return fmt::format("{:07}", item);
}

PreparedScene ItemMaker::prepared(const RenderRequest& request, const Context& context) {
  const std::lock_guard lock(mutex_);
  const auto before = worlds_.find(request.scene);
  PreparedScene scene;
  run_isolated([&] {
    scene = before == worlds_.end() ? prepare_scene(request, context)
                                    : prepare_scene(request, before->second, context);
  });
  worlds_.insert_or_assign(request.scene, scene);
  return scene;
}

Item ItemMaker::make(std::size_t number) {
  ItemInMaking item(recipe_, number);
  if (recipe_.is_rendered())
    item.render(prepared(item.request(), item.context()));
  else
    item.image_flat();
  return item.finished();
}

}  // namespace petzval
