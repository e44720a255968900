// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/colour/illuminants.h>
#include <petzval/scene/charts.h>
#include <petzval/scene/depth_map.h>
#include <petzval/scene/formats/envi.h>
#include <petzval/scene/formats/iset_mat.h>
#include <petzval/scene/formats/name_file.h>
#include <petzval/scene/formats/npy_scene.h>
#include <petzval/scene/formats/scene_exr.h>
#include <petzval/scene/illuminant_swap.h>
#include <petzval/scene/photograph_scene.h>
#include <petzval/scene/scene_file.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <span>
#include <string_view>

namespace petzval {

namespace fs = std::filesystem;

namespace {

/// A chart by name, with the parameter that may follow a colon.
struct Chart {
  const char* name;
  const char* parameter;  // "" if it takes none
  const char* description;
  Scene (*make)(const ChartOptions& options, std::optional<double> parameter);
  bool deep = false;  // stands at a finite distance, with depth
};

int whole(double parameter, const char* chart) {
  if (!(parameter >= 1 && parameter <= 1e6) || parameter != std::floor(parameter))
    throw InputError(fmt::format("{}:{}: a whole number from 1 up would be right", chart, parameter));
  return static_cast<int>(parameter);
}

constexpr std::array charts = {
    Chart{"cards", "", "three cards before a wall with lamps, at four depths",
          [](const ChartOptions& options, std::optional<double>) { return cards_chart(options); }, true},
    Chart{"checkerboard", "N", "black and white squares, N (16) across",
          [](const ChartOptions& options, std::optional<double> n) {
            return checkerboard_chart(options, whole(n.value_or(16), "checkerboard"));
          }},
    Chart{"colorchecker", "", "the 24 patches of a ColorChecker, measured reflectances",
          [](const ChartOptions& options, std::optional<double>) { return colorchecker_chart(options); }},
    Chart{"points", "N", "N x N (9 x 9) white samples on black",
          [](const ChartOptions& options, std::optional<double> n) {
            return point_chart(options, whole(n.value_or(9), "points"));
          }},
    Chart{"slanted-edge", "DEGREES", "a dark and a light half, the edge 5 degrees from the vertical",
          [](const ChartOptions& options, std::optional<double> angle) {
            return slanted_edge_chart(options, angle.value_or(5));
          }},
    Chart{"slanted-plane", "", "a checkerboard that recedes from left to right, with depth",
          [](const ChartOptions& options, std::optional<double>) { return slanted_plane_chart(options); },
          true},
    Chart{"studio", "", "ColorChecker, greys, slanted edges, stars, bars, lettering on a line grid",
          [](const ChartOptions& options, std::optional<double>) { return studio_chart(options); }},
    Chart{"wall", "", "white everywhere",
          [](const ChartOptions& options, std::optional<double>) { return wall_chart(options); }},
};

std::string shown_name(const Chart& chart) {
  return *chart.parameter ? fmt::format("{}[:{}]", chart.name, chart.parameter) : chart.name;
}

std::optional<double> parse_number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

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
  return chart;
}

/// The chart that a text such as "points:5" means, or none.
const Chart* find_chart(const std::string& text) {
  const std::string name = text.substr(0, text.find(':'));
  const auto chart =
      std::find_if(charts.begin(), charts.end(), [&](const Chart& c) { return c.name == name; });
  return chart == charts.end() ? nullptr : &*chart;
}

/// What only files of bare numbers leave open.
void refuse_cube_options(const std::string& what, const SceneOptions& options) {
  if (options.quantity || options.scale || !options.radiance_unit.empty() || !options.file_bands_nm.empty() ||
      options.negative_is_zero)
    throw InputError(what,
                     "says what its numbers are; --scene-quantity, --scene-unit, --scene-scale, "
                     "--scene-bands and --scene-negative-zero are for ENVI, NumPy and OpenEXR files");
}

void refuse_thermal_options(const std::string& what, const SceneOptions& options) {
  if (options.thermal.temperature_k || options.thermal.background_k || options.thermal.emissivity != 1)
    throw InputError(what,
                     "is no thermal scene; --scene-temperature, --scene-emissivity and --scene-background "
                     "are for emissivities and maps of temperature");
}

Scene make_chart(const std::string& text, const Chart& chart, const SceneOptions& options) {
  const std::size_t colon = text.find(':');
  std::optional<double> parameter;
  if (colon != std::string::npos) {
    parameter = parse_number(std::string_view(text).substr(colon + 1));
    if (!*chart.parameter || !parameter)
      throw InputError(fmt::format("scene {}: {} would be right", text, shown_name(chart)));
  }
  if (options.encoding)
    throw InputError(
        fmt::format("scene {}: a chart has no encoding; --scene-encoding is for photographs", text));
  refuse_cube_options("scene " + text, options);
  refuse_thermal_options("scene " + text, options);
  if (chart.deep && options.distance_m && std::isinf(*options.distance_m))
    throw InputError(fmt::format(
        "scene {}: its depths are multiples of a finite --scene-distance (1 m unless given)", text));
  Scene scene = chart.make(chart_options(options), parameter);
  scene.name = text;
  return scene;
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
  return cube;
}

Scene read_cube_file(const std::string& path, const std::string& extension, const SceneOptions& options) {
  SpectralCube cube = extension == ".exr"   ? read_scene_exr(path)
                      : extension == ".npy" ? read_npy_scene(path)
                                            : read_envi(path);
  const std::optional<SceneQuantity> quantity = options.quantity ? options.quantity : cube.quantity;
  if (quantity == SceneQuantity::radiance || quantity == SceneQuantity::reflectance)
    refuse_thermal_options(path, options);
  return naming_file(path, [&] { return scene_of(std::move(cube), cube_options(options)); });
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
  if (extension != ".mat" && extension != ".exr" && extension != ".npy" && !is_envi_path(path))
    throw InputError(path,
                     "a scene is an ISET .mat, a spectral .exr, an ENVI .hdr, a NumPy .npy, a photograph "
                     "(.png, .jpg, .tif) "
                     "or a chart's name (petzval scene list)");
  if (options.encoding) throw InputError(path, "holds spectra; --scene-encoding is for photographs");
  return extension == ".mat" ? read_mat_file(path, options) : read_cube_file(path, extension, options);
}

Scene read_scene_file(const std::string& path, const SceneOptions& options) {
  if (options.columns || options.rows)
    throw InputError(path, "has a size of its own; --scene-size is for charts");
  const bool is_photograph = has_photograph_name(path);
  if (is_photograph) refuse_cube_options(path, options), refuse_thermal_options(path, options);
  Scene scene = is_photograph ? read_photograph_file(path, options) : read_spectral_file(path, options);
  if (scene.name.empty()) scene.name = fs::path(path).stem().string();
  if (options.distance_m) scene.set_distance_m(finite_distance(*options.distance_m));
  if (is_photograph) return scene;
  if (options.horizontal_angle_deg && !options.panorama)
    scene.set_horizontal_angle_deg(*options.horizontal_angle_deg);
  if (options.mean_luminance_cd_m2) scene.set_mean_luminance_cd_m2(*options.mean_luminance_cd_m2);
  if (!options.wavelengths_nm.empty() && options.wavelengths_nm != scene.wavelengths_nm())
    scene = scene.resampled(options.wavelengths_nm);
  return scene;
}

/// A bundled scene of this name, or a complaint that names the nearest ones and all charts.
std::string find_scene_file(const std::string& name) {
  std::vector<std::string> known;
  for (const char* extension : {".exr", ".mat"})
    for (const std::string& bundled : bundled_names("scenes", extension)) {
      if (bundled == name) return (fs::path(data_directory()) / "scenes" / (name + extension)).string();
      known.push_back(bundled);
    }
  for (const Chart& chart : charts) known.push_back(chart.name);
  throw InputError(name, fmt::format("no such file, and no scene of that name; the nearest are {}",
                                     fmt::join(nearest_names(name, known), ", ")));
}

/// Adds one item of a list of wavelengths: a number or from:step:to.
void add_wavelengths(std::string_view item, std::vector<double>& wavelengths, const std::string& all) {
  const auto complain = [&] {
    throw InputError(
        fmt::format("wavelengths {}: write 400:10:700 (from, step, to) or a list such as 450,550,650", all));
  };
  constexpr double max_count = 10000;
  std::vector<double> numbers;
  for (std::size_t from = 0; from <= item.size();) {
    const std::size_t to = std::min(item.find(':', from), item.size());
    const std::optional<double> number = parse_number(item.substr(from, to - from));
    if (!number || !(*number > 0)) complain();
    numbers.push_back(*number);
    from = to + 1;
  }
  if (numbers.size() == 1) return wavelengths.push_back(numbers[0]);
  if (numbers.size() != 3 || numbers[2] < numbers[0]) complain();
  const double steps = (numbers[2] - numbers[0]) / numbers[1];
  if (!(steps < max_count)) complain();
  // The end belongs to the range although steps such as 0.1 do not add up to it exactly.
  constexpr double rounding = 1e-9;
  for (int i = 0; i <= std::floor(steps + rounding); ++i) wavelengths.push_back(numbers[0] + i * numbers[1]);
}

Scene read_plane(const std::string& path_or_name, const SceneOptions& options) {
  if (is_file(path_or_name)) return read_scene_file(path_or_name, options);
  if (const Chart* chart = find_chart(path_or_name)) return make_chart(path_or_name, *chart, options);
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
        "has no depth map; --scene-depth-scale and --scene-depth-from are for scenes that have one");
  if (options.depth_from) scene.depth_from = *options.depth_from;
  if (options.depth_scale)
    for (float& depth : scene.depth_m) depth = static_cast<float>(double(depth) * *options.depth_scale);
  naming_file(options.depth.empty() || options.depth == "none" ? scene.name : options.depth,
              [&] { scene.validate(); });
  return scene;
}

}  // namespace

Scene read_scene(const std::string& path_or_name, const SceneOptions& options) {
  if (path_or_name.empty()) throw InputError("an empty name for a scene");
  if (!options.panorama) return with_depth(read_plane(path_or_name, options), options);
  if (options.horizontal_angle_deg)
    throw InputError(path_or_name, "is a panorama, 360 degrees wide; --scene-angle is for plane scenes");
  SceneOptions plane = options;
  constexpr double any_angle_deg = 90;  // no file need say how wide it is
  plane.horizontal_angle_deg = any_angle_deg;
  if (!plane.distance_m) plane.distance_m = std::numeric_limits<double>::infinity();
  Scene scene = read_plane(path_or_name, plane);
  naming_file(path_or_name, [&] { scene.make_panorama(*options.panorama); });
  return with_depth(std::move(scene), options);
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

std::vector<BuiltinScene> builtin_scenes() {
  std::vector<BuiltinScene> scenes;
  for (const Chart& chart : charts) scenes.push_back({shown_name(chart), chart.description});
  return scenes;
}

std::vector<double> parse_wavelengths_nm(const std::string& text) {
  std::vector<double> wavelengths;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t to = std::min(text.find(',', from), text.size());
    add_wavelengths(std::string_view(text).substr(from, to - from), wavelengths, text);
    from = to + 1;
  }
  for (std::size_t i = 1; i < wavelengths.size(); ++i)
    if (!(wavelengths[i] > wavelengths[i - 1]))
      throw InputError(fmt::format("wavelengths {}: they must increase", text));
  return wavelengths;
}

}  // namespace petzval
