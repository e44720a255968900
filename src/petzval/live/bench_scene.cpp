// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/imaging/distortion.h>
#include <petzval/imaging/field_of_view.h>
#include <petzval/live/bench_scene.h>
#include <petzval/scene/scene_file.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace petzval {

namespace {

constexpr double any_angle_deg = 40;  // until the scene is placed

/// \throws InputError that says how a file comes to say what it leaves open.
[[noreturn]] void refuse_open_question(const std::string& path, const InputError& error) {
  throw InputError(path,
                   error.parts().problem +
                       "; petzval scene convert is told what is missing, and writes a .exr that says it");
}

SceneOptions options_of(const std::string& illuminant, const std::vector<double>& wavelengths_nm) {
  return {.wavelengths_nm = wavelengths_nm,
          .horizontal_angle_deg = any_angle_deg,
          .distance_m = INFINITY,
          .illuminant = illuminant,
          .depth = "none"};
}

/// Reflectances are lit by daylight if nobody says by what; those of infrared by a lamp.
Scene read_whole(BenchScene& scene) {
  std::optional<InputError> refused;
  for (const char* illuminant : {"", "D65", "2856K"}) {
    scene.usual_illuminant = illuminant;
    try {
      return read_scene(scene.path, options_of(illuminant, {}));
    } catch (const InputError& error) {
      if (refused) continue;
      const std::string& open = error.parts().parameter;
      if (open == "scene.illuminant") continue;
      if (!open.empty()) refuse_open_question(scene.path, error);
      if (scene.usual_illuminant.empty()) throw;
      refused = error;
    }
  }
  throw *refused;
}

void check_values(const BenchScene& scene, int columns, int rows, std::size_t bands) {
  if (scene.samples * bands <= most_bench_values) return;
  throw InputError(scene.path,
                   fmt::format("has {} x {} samples in {} bands; the bench takes up to {} million "
                               "values of a spectral file",
                               columns, rows, bands, most_bench_values / 1000000));
}

}  // namespace

std::vector<double> BenchScene::wavelengths_nm(const std::vector<double>& liked_nm) const {
  if (!is_spectral()) return liked_nm;
  const double first = file_bands_nm.front(), last = file_bands_nm.back();
  std::vector<double> chosen;
  if (last > liked_nm.front() && first < liked_nm.back()) {
    for (const double nm : liked_nm) chosen.push_back(std::clamp(nm, first, last));
  } else {
    const std::size_t steps = std::min(liked_nm.size(), file_bands_nm.size());
    for (std::size_t i = 0; i < steps; ++i)
      chosen.push_back(file_bands_nm[i * (file_bands_nm.size() - 1) / std::max<std::size_t>(steps - 1, 1)]);
  }
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  return chosen;
}

BenchScene bench_scene(const std::string& path) {
  BenchScene scene{.path = path};
  if (is_open_scene(path)) {
    constexpr double any_nm = 550;
    const Scene read = read_scene(path, {.wavelengths_nm = {any_nm}});
    if (!is_builtin_scene(path)) scene.samples = read.band_size();
    return scene;
  }
  const Scene read = read_whole(scene);
  scene.file_bands_nm = read.wavelengths_nm();
  scene.samples = read.band_size();
  scene.notes = read.notes;
  check_values(scene, read.columns(), read.rows(), scene.file_bands_nm.size());
  return scene;
}

Scene read_bench_scene(const BenchScene& scene, const std::string& illuminant,
                       const std::vector<double>& wavelengths_nm) {
  return read_scene(scene.path,
                    options_of(illuminant.empty() ? scene.usual_illuminant : illuminant, wavelengths_nm));
}

void place_bench_scene(Scene& scene, const TableCamera& optics, const ImageOptions& options) {
  std::optional<double> distance_m;
  if (const auto distance_mm = object_to_sensor_mm(optics.table)) distance_m = *distance_mm / mm_per_m;
  scene.set_distance_m(distance_m);
  scene.set_horizontal_angle_deg(
      covering_angle_deg(scene, optics.table, optics.sensor->geometry, options.imaging));
}

}  // namespace petzval
