// SPDX-License-Identifier: BSD-3-Clause
// What a data set is made of: cameras and scenes by distributions, how many pictures, which truth beside
// them.
#pragma once

#include <petzval/dataset/distribution.h>
#include <petzval/lens/tolerance.h>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace petzval {

/// What is stored beside the picture of an item.
enum class Truth {
  raw,         ///< the raw image, .dng
  irradiance,  ///< on the sensor, without noise: [row][column][band] [W·m⁻²·nm⁻¹], .npy
  electrons,   ///< mean electrons of every pixel, without noise: [row][column], .npy
  sharp,       ///< the picture without blur and without noise, developed alike, .png
  psf,         ///< PSFs at a grid of places: [grid row][grid column][band][row][column], .npy
  rays,        ///< tangents of the direction that every pixel sees: [row][column][right, down], .npy
  depth,       ///< of three-dimensional scenes and of those with depth: [row][column] [m], .npy
  normals,     ///< of three-dimensional scenes, world space: [row][column][3], .npy
  albedo,      ///< of three-dimensional scenes: [row][column][band], .npy
  masks,       ///< of three-dimensional scenes: [row][column][object, material], whole numbers, .npy
  flow         ///< of a camera that moves in one: [row][column][right, down] [pixels], .npy
};
/// Their names, in order.
const std::vector<std::string>& truth_names();

/// A parameter that a recipe may draw.
struct RecipeParameter {
  const char* name;
  const char* meaning;  ///< with its unit
  bool is_name;         ///< its values are names, not numbers
  double least, most;   ///< of a number
  bool is_whole = false;
};
/// The largest whole number that a recipe can say: a double holds it, and none beside it.
inline constexpr double most_whole = 9007199254740991;  // 2^53 - 1
/// All of them. A parameter's place in this list is part of its random numbers: new ones go to the end.
const std::vector<RecipeParameter>& recipe_parameters();

/// Those of single lights of a world, by render::LightChange::Kind; the light's number is added to the name.
const std::vector<RecipeParameter>& light_parameters();
struct LightParameter {
  std::size_t kind, light;
};
/// Of "light_scale@0"; nothing for other names.
std::optional<LightParameter> light_parameter(std::string_view name);

/// Item i is a function of (recipe, i) alone, whoever makes it, wherever and when.
struct Recipe {
  std::size_t items = 0;
  std::size_t items_per_part = 50;  ///< in one file, which is what one process makes at a time
  std::uint64_t seed = 1;
  /// By the names of recipe_parameters(), or as light_parameter() takes them.
  std::map<std::string, Distribution> parameters = {};
  std::vector<Tolerance> build_tolerances = {};   ///< of builds; none: the lens's own, or a grade's
  std::vector<std::string> sensor_settings = {};  ///< "columns=640", as read_sensor() takes them
  std::vector<double> wavelengths_nm = {};        ///< empty: as the scene has them
  double tolerance = 1e-3;                        ///< of image formation
  int samples_per_pixel = 64;                     ///< of three-dimensional scenes
  bool denoise_light = false;                     ///< of them, before the sensor
  int bits = 8;                                   ///< of pictures
  std::set<Truth> truth = {};
  int psf_rows = 3, psf_columns = 3, psf_size = 31;  ///< the grid of places, and pixels a side of a PSF
  std::string text = {};    ///< the recipe as JSON, keys in order: what it is told by
  std::string folder = {};  ///< that relative names of files start from; empty: here

  std::size_t parts() const { return (items + items_per_part - 1) / items_per_part; }
  /// Numbers [first, last) of a part's items.
  std::array<std::size_t, 2> items_of(std::size_t part) const;
  bool has(Truth what) const { return truth.contains(what); }
  bool is_rendered() const { return parameters.contains("world"); }
};

/// Reads a recipe (docs/DATASETS.md). \throws InputError with file and line for what is wrong, unknown or
/// contradicts itself.
Recipe read_recipe(const std::string& path);
/// \param file  for messages. \param folder  that relative names of files start from.
Recipe parse_recipe(const std::string& text, const std::string& file, const std::string& folder = {});

/// The text of a small recipe to start from.
std::string starter_recipe();

/// What one item is made of: the value of every parameter that the recipe names.
std::map<std::string, ParameterValue> draw_item(const Recipe& recipe, std::size_t item);

}  // namespace petzval
