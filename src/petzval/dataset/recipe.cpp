// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/dataset/recipe.h>
#include <petzval/numeric/random.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <limits>

namespace petzval {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
/// Purpose of the random numbers of the first parameter; those of the others follow.
constexpr std::uint32_t first_purpose = 0x44530000;  // "DS"
/// Of those of single lights.
constexpr std::uint32_t first_light_purpose = first_purpose + 0x1000;
constexpr std::size_t most_lights = 9999;

}  // namespace

const std::vector<std::string>& truth_names() {
  static const std::vector<std::string> names = {"raw",   "irradiance", "electrons", "sharp", "psf", "rays",
                                                 "depth", "normals",    "albedo",    "masks", "flow"};
  return names;
}

const std::vector<RecipeParameter>& recipe_parameters() {
  constexpr double any = infinite, tiny = 1e-9;
  static const std::vector<RecipeParameter> all = {
      {"lens", "a file or the name of a bundled lens", true, 0, 0},
      {"grade", "of its tolerances, where the lens has none: commercial, precision or high", true, 0, 0},
      {"build", "which lens off the line; absent: as designed", false, 0, most_whole, true},
      {"f_number", "paraxial, at infinity; absent: as designed", false, tiny, 1e6},
      {"stop_down_ev", "stops below the lens's widest, in place of an f-number", false, 0, 40},
      {"focus", "as a camera takes it: infinity, 1.2m, best-spot; absent: on the scene", true, 0, 0},
      {"focus_distance_m", "from the sensor, in place of a focus", false, tiny, 1e9},
      {"defocus_mm", "of the sensor from there, away from the lens", false, -1e3, 1e3},
      {"sensor", "a file or the name of a bundled sensor", true, 0, 0},
      {"sensor_serial", "which copy of the sensor: its fixed patterns", false, 0, most_whole, true},
      {"scene", "a chart, a photograph or a spectral file", true, 0, 0},
      {"scene_distance_m", "from the sensor; absent: the scene's, or infinity", false, tiny, 1e9},
      {"scene_angle_deg", "its width; absent: charts and photographs fill the frame", false, tiny, 179},
      {"luminance_cd_m2", "the scene's mean; absent: the file's, or 100", false, tiny, 1e12},
      {"illuminant", "of charts, photographs and reflectances", true, 0, 0},
      {"world", "a three-dimensional scene, in place of a flat one", true, 0, 0},
      {"camera_x", "place of the camera [scene units]; all three or none", false, -any, any},
      {"camera_y", "as camera_x", false, -any, any},
      {"camera_z", "as camera_x", false, -any, any},
      {"look_x", "what is in the middle of the picture [scene units]; all three or none", false, -any, any},
      {"look_y", "as look_x", false, -any, any},
      {"look_z", "as look_x", false, -any, any},
      {"light_scale", "all lights of a three-dimensional scene this much stronger", false, tiny, 1e12},
      {"exposure_s", "absent: automatic", false, 1e-9, 1e6},
      {"exposure_compensation_ev", "of automatic exposure", false, -40, 40},
      {"analog_gain", "of the sensor; absent: 1", false, tiny, 1e6},
      {"white_balance", "as `petzval develop` takes it; absent: as-shot", true, 0, 0},
      {"brightness_ev", "of the developed picture", false, -40, 40},
      {"camera_move_x", "of the camera while its shutter is open [scene units]; all three or none", false,
       -any, any},
      {"camera_move_y", "as camera_move_x", false, -any, any},
      {"camera_move_z", "as camera_move_x", false, -any, any},
      {"look_move_x", "of what is in the middle of the picture meanwhile; all three or none", false, -any,
       any},
      {"look_move_y", "as look_move_x", false, -any, any},
      {"look_move_z", "as look_move_x", false, -any, any},
      {"rolling_shutter", "share of that time by which the last row begins after the first", false, 0,
       0.999999},
      {"state", "zoom or focus position of the lens by its name; absent: as the file stands", true, 0, 0},
      {"state_number", "the same by number, counted from 0; 0.5 lies half-way to the next", false, 0, 1e6},
  };
  return all;
}

const std::vector<RecipeParameter>& light_parameters() {
  static const std::vector<RecipeParameter> kinds = {
      {"light_scale@", "one light of a world so many times as strong", false, 0, 1e12},
      {"light_turn_deg@", "the same turned about the upright axis of the world", false, -1e6, 1e6},
      {"light_kelvin@", "with the colour of a black body", false, 100, 1e6},
  };
  return kinds;
}

std::optional<LightParameter> light_parameter(std::string_view name) {
  const std::vector<RecipeParameter>& kinds = light_parameters();
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    const std::string_view start = kinds[kind].name;
    if (!name.starts_with(start)) continue;
    const std::string_view number = name.substr(start.size());
    std::size_t light = 0;
    const auto [end, problem] = std::from_chars(number.data(), number.data() + number.size(), light);
    if (problem == std::errc() && end == number.data() + number.size() && light <= most_lights)
      return LightParameter{kind, light};
  }
  return {};
}

std::string starter_recipe() {
  return R"({
  "format": "petzval-dataset/1",
  "about": "eight pictures through three lenses, with the sharp picture, PSFs and rays beside each",
  "items": 8,
  "items_per_part": 4,
  "seed": 1,
  "parameters": {
    "lens": {"choose": ["dgauss-50mm", "edmund-54852", "wide-22mm"]},
    "stop_down_ev": {"uniform": [0, 3]},
    "defocus_mm": {"normal": [0, 0.02]},
    "scene": {"choose": ["studio", "dead-leaves", "checkerboard:10"]},
    "sensor": "example-vga",
    "exposure_compensation_ev": {"normal": [0, 0.5], "within": [-1, 1]}
  },
  "sensor_set": ["columns=160", "rows=120"],
  "wavelengths_nm": "450:50:650",
  "tolerance": 0.01,
  "truth": ["sharp", "psf", "rays"],
  "psf_grid": {"rows": 3, "columns": 3, "size": 31}
}
)";
}

std::array<std::size_t, 2> Recipe::items_of(std::size_t part) const {
  return {part * items_per_part, std::min(items, (part + 1) * items_per_part)};
}

std::map<std::string, ParameterValue> draw_item(const Recipe& recipe, std::size_t item) {
  std::map<std::string, ParameterValue> values;
  const std::vector<RecipeParameter>& all = recipe_parameters();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto found = recipe.parameters.find(all[i].name);
    if (found == recipe.parameters.end()) continue;
    RandomStream random(recipe.seed, first_purpose + static_cast<std::uint32_t>(i), item);
    values.emplace(all[i].name, found->second.at(random.uniform()));
  }
  for (const auto& [name, distribution] : recipe.parameters) {
    const auto light = light_parameter(name);
    if (!light) continue;
    const std::size_t number = light->light * light_parameters().size() + light->kind;
    RandomStream random(recipe.seed, first_light_purpose + static_cast<std::uint32_t>(number), item);
    values.emplace(name, distribution.at(random.uniform()));
  }
  return values;
}

}  // namespace petzval
