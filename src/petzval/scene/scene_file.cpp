// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/colour/illuminants.h>
#include <petzval/scene/depth_map.h>
#include <petzval/scene/formats/envi.h>
#include <petzval/scene/formats/iset_mat.h>
#include <petzval/scene/formats/name_file.h>
#include <petzval/scene/formats/npy_scene.h>
#include <petzval/scene/formats/scene_exr.h>
#include <petzval/scene/illuminant_swap.h>
#include <petzval/scene/named_chart.h>
#include <petzval/scene/photograph_scene.h>
#include <petzval/scene/scene_file.h>
#include <petzval/scene/scene_light.h>
#include <petzval/scene/tilted_plane.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string_view>

namespace petzval {

namespace fs = std::filesystem;

namespace {

std::optional<double> finite_distance(double distance_m) {
  return std::isinf(distance_m) && distance_m > 0 ? std::nullopt : std::optional(distance_m);
}

ChartOptions chart_options(const SceneOptions& options) {
  ChartOptions chart;
  chart.columns = options.columns.value_or(chart.columns);
  chart.rows = options.rows.value_or(chart.rows);
  chart.wavelengths_nm = options.wavelengths_nm;
  chart.horizontal_angle_deg = options.horizontal_angle_deg.value_or(chart.horizontal_angle_deg);
  if (options.distance_m) chart.distance_m = finite_distance(*options.distance_m);
  if (!options.illuminant.empty()) chart.illuminant = options.illuminant;
  chart.mean_luminance_cd_m2 = options.mean_luminance_cd_m2.value_or(chart.mean_luminance_cd_m2);
  chart.band_width_nm = options.band_width_nm;
  return chart;
}

/// What only files of bare numbers leave open.
void refuse_cube_options(const std::string& what, const SceneOptions& options) {
  if (options.quantity || options.scale || !options.radiance_unit.empty() || !options.file_bands_nm.empty() ||
      options.negative_is_zero)
    throw InputError(
        what,
        "says what its numbers are; `scene.quantity`, `scene.radiance_unit`, `scene.scale`, "
        "`scene.file_bands_nm` and `scene.negative_is_zero` are for ENVI, NumPy and OpenEXR files");
}

void refuse_thermal_options(const std::string& what, const SceneOptions& options) {
  if (options.thermal.temperature_k || options.thermal.background_k || options.thermal.emissivity != 1)
    throw InputError(
        what,
        "is no thermal scene; `scene.temperature_k`, `scene.emissivity` and `scene.background_k` "
        "are for emissivities and maps of temperature");
}

Scene with_settled_light(Scene scene, std::optional<double> band_width_nm) {
  const std::optional<Spectrum> light = scene.illuminant;
  settle_illuminant(scene, band_width_nm);
  if (!band_width_nm) note_unknown_width(scene, light);
  return scene;
}

/// A file's scene at the bands that were asked for.
Scene at_wanted_bands(Scene scene, const SceneOptions& options) {
  const std::optional<Spectrum> light = scene.illuminant;
  if (!options.illuminant.empty()) settle_illuminant(scene, {});
  const bool others = !options.wavelengths_nm.empty() && options.wavelengths_nm != scene.wavelengths_nm();
  if (others) scene = scene.resampled(options.wavelengths_nm);
  if (others || options.band_width_nm) widen_bands(scene, light, options.band_width_nm);
  if (!options.band_width_nm) note_unknown_width(scene, light);
  return scene;
}

/// As bright as was asked for.
void set_level(Scene& scene, const SceneOptions& options) {
  if (int(options.mean_luminance_cd_m2.has_value()) + int(options.illuminance_lx.has_value()) +
          int(options.irradiance_w_m2.has_value()) >
      1)
    throw InputError(
        "`scene.mean_luminance_cd_m2` and `scene.illuminance_lx` both say how bright the scene is; one of "
        "them would be right");
  if (options.mean_luminance_cd_m2 && scene.illuminant && !is_visible(*scene.illuminant))
    throw InputError(
        scene.name,
        "is lit by light that no eye sees, which has no luminance; `scene.irradiance_w_m2` 5W/m2 "
        "would be right");
  if (options.illuminance_lx) set_illuminance_lx(scene, *options.illuminance_lx);
  if (options.irradiance_w_m2) set_irradiance_w_m2(scene, *options.irradiance_w_m2);
}

/// Stars have a light of their own and stand where they stand.
void refuse_light_on_stars(const std::string& text, const SceneOptions& options) {
  if (!options.illuminant.empty() || options.illuminance_lx || options.irradiance_w_m2)
    throw InputError(fmt::format(
        "scene {}: stars shine by themselves; `scene.illuminant` and `scene.illuminance_lx` are for charts "
        "that reflect",
        text));
  if ((options.distance_m && std::isfinite(*options.distance_m)) || options.tilt_deg)
    throw InputError(fmt::format(
        "scene {}: stars stand at infinity; `scene.distance_m` and `scene.tilt_deg` are for other charts",
        text));
}

Scene read_sky(const std::string& text, const NamedChart& chart, const SceneOptions& options) {
  refuse_light_on_stars(text, options);
  Scene scene = make_chart(text, chart, chart_options(options));
  if (options.mean_luminance_cd_m2) scene.set_mean_luminance_cd_m2(*options.mean_luminance_cd_m2);
  if (options.band_width_nm) {
    widen_bands(scene, {}, options.band_width_nm);
  } else {
    note_unknown_width(scene, {});
  }
  return scene;
}

Scene read_chart(const std::string& text, const NamedChart& chart, const SceneOptions& options) {
  if (options.encoding)
    throw InputError(
        fmt::format("scene {}: a chart has no encoding; `scene.encoding` is for photographs", text));
  refuse_cube_options("scene " + text, options);
  refuse_thermal_options("scene " + text, options);
  if (chart.is_sky) return read_sky(text, chart, options);
  if (chart.deep && options.distance_m && std::isinf(*options.distance_m))
    throw InputError(fmt::format(
        "scene {}: its depths are multiples of a finite `scene.distance_m` (1 m unless given)", text));
  Scene scene = make_chart(text, chart, chart_options(options));
  if (options.columns || options.rows) scene.forget_drawing();  // these samples were asked for
  set_level(scene, options);
  return with_settled_light(std::move(scene), options.band_width_nm);
}

bool is_file(const std::string& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

std::string lower_extension(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return extension;
}

Scene read_photograph_file(const std::string& path, const SceneOptions& options) {
  PhotographOptions photograph;
  photograph.encoding = options.encoding.value_or(photograph.encoding);
  photograph.wavelengths_nm = options.wavelengths_nm;
  photograph.horizontal_angle_deg = options.horizontal_angle_deg.value_or(photograph.horizontal_angle_deg);
  if (!options.illuminant.empty()) photograph.illuminant = options.illuminant;
  photograph.mean_luminance_cd_m2 = options.mean_luminance_cd_m2.value_or(photograph.mean_luminance_cd_m2);
  photograph.band_width_nm = options.band_width_nm;
  return read_photograph_scene(path, photograph);
}

CubeOptions cube_options(const SceneOptions& options) {
  CubeOptions cube;
  cube.quantity = options.quantity;
  cube.radiance_unit = options.radiance_unit;
  cube.scale = options.scale.value_or(1);
  cube.file_bands_nm = options.file_bands_nm;
  cube.wavelengths_nm = options.wavelengths_nm;
  cube.horizontal_angle_deg = options.horizontal_angle_deg;
  if (!options.illuminant.empty()) cube.illuminant = illuminant(options.illuminant);
  cube.thermal = options.thermal;
  cube.negative_is_zero = options.negative_is_zero;
  cube.level_follows = options.mean_luminance_cd_m2 || options.illuminance_lx || options.irradiance_w_m2;
  return cube;
}

Scene read_cube_file(const std::string& path, const std::string& extension, const SceneOptions& options) {
  const CubeOptions wanted = cube_options(options);
  const CubeCheck check = [&](const SpectralCube& cube) {
    const std::optional<SceneQuantity> quantity = options.quantity ? options.quantity : cube.quantity;
    if (quantity == SceneQuantity::radiance || quantity == SceneQuantity::reflectance)
      refuse_thermal_options(path, options);
    naming_file(path, [&] { check_cube(cube, wanted); });
  };
  SpectralCube cube = extension == ".exr"   ? read_scene_exr(path, check)
                      : extension == ".npy" ? read_npy_scene(path, check)
                                            : read_envi(path, check);
  return naming_file(path, [&] { return scene_of(std::move(cube), wanted); });
}

Scene read_mat_file(const std::string& path, const SceneOptions& options) {
  refuse_cube_options(path, options);
  refuse_thermal_options(path, options);
  Scene scene = read_iset_mat(path, options.horizontal_angle_deg);
  if (!options.illuminant.empty())
    naming_file(path, [&] { swap_illuminant(scene, illuminant(options.illuminant)); });
  return scene;
}

Scene read_spectral_file(const std::string& path, const SceneOptions& options) {
  const std::string extension = lower_extension(path);
  if (extension == ".pbrt" || extension == ".gltf" || extension == ".glb")
    throw InputError(path, "is a scene in three dimensions; petzval render takes it");
  if (extension != ".mat" && extension != ".exr" && extension != ".npy" && !is_envi_path(path))
    throw InputError(path,
                     "a scene is an ISET .mat, a spectral .exr, an ENVI .hdr, a NumPy .npy, a photograph "
                     "(.png, .jpg, .tif) "
                     "or a chart's name (petzval scene list)");
  if (options.encoding) throw InputError(path, "holds spectra; `scene.encoding` is for photographs");
  return extension == ".mat" ? read_mat_file(path, options) : read_cube_file(path, extension, options);
}

Scene read_scene_file(const std::string& path, const SceneOptions& options) {
  if (options.columns || options.rows)
    throw InputError(path, "has a size of its own; `scene.size` is for charts");
  const bool is_photograph = has_photograph_name(path);
  if (is_photograph) refuse_cube_options(path, options), refuse_thermal_options(path, options);
  Scene scene = is_photograph ? read_photograph_file(path, options) : read_spectral_file(path, options);
  if (scene.name.empty()) scene.name = fs::path(path).stem().string();
  if (options.distance_m) scene.set_distance_m(finite_distance(*options.distance_m));
  set_level(scene, options);
  if (is_photograph) return with_settled_light(std::move(scene), options.band_width_nm);
  if (options.horizontal_angle_deg && !options.panorama)
    scene.set_horizontal_angle_deg(*options.horizontal_angle_deg);
  if (options.mean_luminance_cd_m2) scene.set_mean_luminance_cd_m2(*options.mean_luminance_cd_m2);
  return at_wanted_bands(std::move(scene), options);
}

/// \throws InputError for what is there and cannot be read as a file.
void refuse_other_than_files(const std::string& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored))
    throw InputError(path, "is a folder; a scene is a file or a chart's name");
  if (fs::exists(path, ignored))
    throw InputError(path, "is a pipe or a device; a scene is read from an ordinary file");
}

/// A bundled scene of this name, or a complaint that names the nearest ones and all charts.
std::string find_scene_file(const std::string& name) {
  std::vector<std::string> known;
  for (const char* extension : {".exr", ".mat"})
    for (const std::string& bundled : bundled_names("scenes", extension)) {
      if (bundled == name) return (fs::path(data_directory()) / "scenes" / (name + extension)).string();
      known.push_back(bundled);
    }
  for (const NamedChart& chart : named_charts()) known.push_back(chart.name);
  throw InputError(name, fmt::format("no such file, and no scene of that name; the nearest are {}",
                                     fmt::join(nearest_names(name, known), ", ")));
}

Scene read_plane(const std::string& path_or_name, const SceneOptions& options) {
  if (is_file(path_or_name)) return read_scene_file(path_or_name, options);
  if (const NamedChart* chart = find_chart(path_or_name)) return read_chart(path_or_name, *chart, options);
  refuse_other_than_files(path_or_name);
  return read_scene_file(find_scene_file(path_or_name), options);
}

/// Depth as the options have it.
Scene with_depth(Scene scene, const SceneOptions& options) {
  if (options.depth == "none") {
    scene.depth_m.clear();
  } else if (!options.depth.empty()) {
    scene.depth_m = read_depth_file(options.depth, scene.columns(), scene.rows());
    scene.depth_from = DepthFrom::sensor;
  }
  if (scene.depth_m.empty() && (options.depth_scale || options.depth_from))
    throw InputError(
        scene.name,
        "has no depth map; `scene.depth_scale` and `scene.depth_from` are for scenes that have one");
  if (options.depth_from) scene.depth_from = *options.depth_from;
  if (options.depth_scale)
    for (float& depth : scene.depth_m) depth = static_cast<float>(double(depth) * *options.depth_scale);
  naming_file(options.depth.empty() || options.depth == "none" ? scene.name : options.depth,
              [&] { scene.validate(); });
  return scene;
}

}  // namespace

namespace {

/// What a width says at a distance. \throws InputError for a width without one.
double angle_of_width_deg(double width_m, std::optional<double> distance_m) {
  if (!distance_m || !std::isfinite(*distance_m))
    throw InputError(
        "`scene.width_m` is a width at a distance; a finite `scene.distance_m` would be right with it");
  return 2 * degrees(std::atan(width_m / 2 / *distance_m));
}

/// A flat scene, as wide as its width or its angle says, and turned.
Scene read_turned_plane(const std::string& path_or_name, SceneOptions options) {
  constexpr double usual_m = 1;
  const bool open = is_open_scene(path_or_name);
  if (open && !options.distance_m && (options.tilt_deg || is_deep_chart(path_or_name)))
    options.distance_m = usual_m;
  if (options.width_m && options.horizontal_angle_deg)
    throw InputError(
        "`scene.width_m` and `scene.horizontal_angle_deg` both say how wide the scene is; one of "
        "them would be right");
  if (options.width_m && (open || options.distance_m))
    options.horizontal_angle_deg = angle_of_width_deg(*options.width_m, options.distance_m);
  Scene scene = read_plane(path_or_name, options);
  if (options.width_m && !options.horizontal_angle_deg)
    scene.set_horizontal_angle_deg(angle_of_width_deg(*options.width_m, scene.distance_m()));
  if (options.tilt_deg) return tilted(scene, *options.tilt_deg);
  return scene;  // moved: a copy of a large scene would be held in memory
}

}  // namespace

Scene read_scene(const std::string& path_or_name, const SceneOptions& options) {
  if (path_or_name.empty()) throw InputError("an empty name for a scene");
  if (!options.panorama) return with_depth(read_turned_plane(path_or_name, options), options);
  if (options.width_m || options.tilt_deg)
    throw InputError(path_or_name,
                     "is a panorama; `scene.width_m` and `scene.tilt_deg` are for plane scenes");
  if (options.horizontal_angle_deg)
    throw InputError(path_or_name,
                     "is a panorama, 360 degrees wide; `scene.horizontal_angle_deg` is for plane scenes");
  SceneOptions plane = options;
  constexpr double any_angle_deg = 90;  // no file need say how wide it is
  plane.horizontal_angle_deg = any_angle_deg;
  if (!plane.distance_m) plane.distance_m = std::numeric_limits<double>::infinity();
  Scene scene = read_plane(path_or_name, plane);
  naming_file(path_or_name, [&] { scene.make_panorama(*options.panorama); });
  return with_depth(std::move(scene), options);
}

std::string scene_companion(const std::string& path) {
  if (!is_file(path)) return {};
  return lower_extension(path) == ".npy" ? npy_companion(path) : envi_companion(path);
}

bool is_builtin_scene(const std::string& path_or_name) {
  return !is_file(path_or_name) && find_chart(path_or_name) != nullptr;
}

bool is_open_scene(const std::string& path_or_name) {
  return is_builtin_scene(path_or_name) || has_photograph_name(path_or_name);
}

bool is_deep_chart(const std::string& path_or_name) {
  return is_builtin_scene(path_or_name) && find_chart(path_or_name)->deep;
}

bool is_drawn_to_angle(const std::string& path_or_name, const SceneOptions& options) {
  return options.tilt_deg || is_sky_chart(path_or_name);
}

bool is_sky_chart(const std::string& path_or_name) {
  return is_builtin_scene(path_or_name) && find_chart(path_or_name)->is_sky;
}

std::vector<BuiltinScene> builtin_scenes() {
  std::vector<BuiltinScene> scenes;
  for (const NamedChart& chart : named_charts()) scenes.push_back({shown_name(chart), chart.description});
  return scenes;
}

}  // namespace petzval
