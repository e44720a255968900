// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/text_lines.h>
#include <petzval/base/transpose.h>
#include <petzval/base/whole_file.h>
#include <petzval/image/formats/npy_file.h>
#include <petzval/scene/formats/name_file.h>
#include <petzval/scene/formats/npy_scene.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>

namespace petzval {

namespace fs = std::filesystem;

namespace {

double number_of(const nlohmann::json& value, const std::string& key, const std::string& file) {
  if (!value.is_number()) throw InputError(file, fmt::format("{} must be a number", key));
  return value.get<double>();
}

std::string text_of(const nlohmann::json& value, const std::string& key, const std::string& file) {
  if (!value.is_string()) throw InputError(file, fmt::format("{} must be text", key));
  return value.get<std::string>();
}

std::vector<double> numbers_of(const nlohmann::json& value, const std::string& key, const std::string& file) {
  if (!value.is_array()) throw InputError(file, fmt::format("{} must be a list of numbers", key));
  std::vector<double> numbers;
  for (const nlohmann::json& each : value) numbers.push_back(number_of(each, key, file));
  return numbers;
}

constexpr std::size_t values_at_once = std::size_t{1} << 22;

/// From (rows, columns, bands) in C order to planes, some rows at a time.
void take_pixels(const NpyFile& file, std::size_t bands, SpectralCube& cube) {
  const std::size_t pixels = cube.band_size();
  const std::size_t block = std::max<std::size_t>(1, values_at_once / bands);
  std::vector<float> values;
  for (std::size_t first = 0; first < pixels; first += block) {
    const std::size_t count = std::min(block, pixels - first);
    values.resize(count * bands);
    file.read(first * bands, std::span(values));
    for (std::size_t band = 0; band < bands; ++band) {
      const std::span<float> plane = cube.plane(band).subspan(first, count);
      for (std::size_t i = 0; i < count; ++i) plane[i] = values[i * bands + band];
    }
    cube.values.release_memory();
  }
}

/// In Fortran order planes lie one behind the other, column by column: some columns at a time, or a part of
/// one.
void take_columns(const NpyFile& file, SpectralCube& cube) {
  const auto rows = static_cast<std::size_t>(cube.rows), columns = static_cast<std::size_t>(cube.columns);
  const std::size_t most_rows = std::min(rows, values_at_once),
                    most_columns = std::max<std::size_t>(1, values_at_once / rows);
  std::vector<float> values;
  for (std::size_t band = 0; band < static_cast<std::size_t>(cube.bands); ++band) {
    const std::span<float> plane = cube.plane(band);
    for (std::size_t column = 0; column < columns; column += most_columns)
      for (std::size_t row = 0; row < rows; row += most_rows) {
        const std::size_t wide = std::min(most_columns, columns - column),
                          high = std::min(most_rows, rows - row);
        values.resize(wide * high);
        file.read((band * columns + column) * rows + row, std::span(values));
        transpose<float>({values.data(), high}, wide, high, {&plane[row * columns + column], columns});
      }
    cube.values.release_memory();
  }
}

void take_planes(const NpyFile& file, SpectralCube& cube) {
  cube.values = LargeFloats(file.size());
  if (file.fortran_order())
    take_columns(file, cube);
  else
    take_pixels(file, static_cast<std::size_t>(cube.bands), cube);
}

}  // namespace

void describe_cube(std::string_view json, const std::string& file, SpectralCube& cube) {
  const nlohmann::json root = nlohmann::json::parse(json, nullptr, false);
  if (!root.is_object())
    throw InputError(file, "is no JSON object; {\"wavelengths_nm\": [450, 550]} would be one");
  for (const auto& [key, value] : root.items()) {
    if (key == "quantity") {
      const std::string word = text_of(value, key, file);
      cube.quantity = naming_file(file, [&word] { return parse_scene_quantity(word); });
    } else if (key == "unit") {
      cube.radiance_unit = text_of(value, key, file);
    } else if (key == "wavelengths_nm") {
      cube.wavelengths_nm = numbers_of(value, key, file);
    } else if (key == "angle_deg") {
      cube.horizontal_angle_deg = number_of(value, key, file);
    } else if (key == "distance_m") {
      cube.distance_m = number_of(value, key, file);
    } else if (key == "name") {
      cube.name = text_of(value, key, file);
    } else if (key == "scale") {
      cube.scale = number_of(value, key, file);
      if (!(cube.scale > 0)) throw InputError(file, "scale must be positive");
    } else {
      throw InputError(file,
                       fmt::format("has the unknown key '{}'; quantity, unit, wavelengths_nm, angle_deg, "
                                   "distance_m, scale and name are known",
                                   quotable(key)));
    }
  }
}

std::string npy_companion(const std::string& path) {
  const fs::path beside = fs::path(path).replace_extension(".json");
  std::error_code ignored;
  return fs::is_regular_file(beside, ignored) ? beside.string() : std::string();
}

SpectralCube read_npy_scene(const std::string& path, const CubeCheck& check) {
  const NpyFile array(path);
  const std::vector<std::size_t>& shape = array.shape();
  if (shape.size() != 2 && shape.size() != 3)
    throw InputError(
        path, fmt::format("has {} dimensions; (rows, columns, bands) or (rows, columns) would be right",
                          shape.size()));
  constexpr std::size_t most = std::numeric_limits<int>::max();
  const std::size_t bands = shape.size() == 3 ? shape[2] : 1;
  if (shape[0] < 1 || shape[1] < 1 || bands < 1 || shape[0] > most || shape[1] > most || bands > most)
    throw InputError(path, fmt::format("is an array of {} x {} x {}; at least one of each would be right",
                                       shape[0], shape[1], bands));
  constexpr double gib = 1024.0 * 1024 * 1024;
  if (array.size() > Scene::max_values)
    throw InputError(
        path, fmt::format("{} x {} samples in {} bands would take {:.1f} GiB; up to {} values fit", shape[1],
                          shape[0], bands, static_cast<double>(array.size()) * sizeof(float) / gib,
                          Scene::max_values));
  SpectralCube cube;
  cube.rows = static_cast<int>(shape[0]), cube.columns = static_cast<int>(shape[1]);
  cube.bands = static_cast<int>(bands);
  if (const std::string beside = npy_companion(path); !beside.empty())
    describe_cube(read_whole_file(beside, std::size_t{1} << 24), beside, cube);
  if (check) check(cube);
  take_planes(array, cube);
  return cube;
}

}  // namespace petzval
