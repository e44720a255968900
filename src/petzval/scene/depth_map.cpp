// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/text_lines.h>
#include <petzval/image/formats/depth_exr.h>
#include <petzval/image/formats/npy.h>
#include <petzval/scene/depth_map.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace petzval {

namespace {

struct Word {
  DepthFrom from;
  const char* word;
};
constexpr std::array words = {Word{DepthFrom::sensor, "sensor"}, Word{DepthFrom::pupil, "pupil"},
                              Word{DepthFrom::range, "range"}};

[[noreturn]] void refuse_size(const std::string& path, std::size_t columns, std::size_t rows,
                              int wanted_columns, int wanted_rows) {
  throw InputError(path, fmt::format("a depth map of {} x {} samples for a scene of {} x {}; one as large as "
                                     "the scene would be right",
                                     columns, rows, wanted_columns, wanted_rows));
}

std::vector<float> read_npy_depth(const std::string& path, int columns, int rows) {
  NpyArray array = read_npy(path);
  if (array.shape.size() == 3 && array.shape[2] == 1) array.shape.pop_back();
  if (array.shape.size() != 2)
    throw InputError(path,
                     fmt::format("has {} dimensions; a depth map has rows and columns", array.shape.size()));
  if (array.shape[0] != static_cast<std::size_t>(rows) || array.shape[1] != static_cast<std::size_t>(columns))
    refuse_size(path, array.shape[1], array.shape[0], columns, rows);
  if (auto* single = std::get_if<std::vector<float>>(&array.values)) return std::move(*single);
  const auto& twice = std::get<std::vector<double>>(array.values);
  std::vector<float> depth(twice.size());
  std::transform(twice.begin(), twice.end(), depth.begin(), [](double v) { return static_cast<float>(v); });
  return depth;
}

std::vector<float> read_exr_depth(const std::string& path, int columns, int rows) {
  std::optional<DepthPlane> plane = read_depth_exr(path);
  if (!plane) throw InputError(path, "has no channel Z; that is where OpenEXR keeps depth");
  if (plane->columns != columns || plane->rows != rows)
    refuse_size(path, static_cast<std::size_t>(plane->columns), static_cast<std::size_t>(plane->rows),
                columns, rows);
  return std::move(plane->values);
}

}  // namespace

DepthFrom parse_depth_from(const std::string& word) {
  for (const Word& known : words)
    if (word == known.word) return known.from;
  throw InputError(fmt::format(
      "depths from '{}': sensor (along the axis, from the sensor plane), pupil (along the axis, from the "
      "entrance pupil) or range (along the line of sight, from the entrance pupil) would be right",
      quotable(word)));
}

const char* depth_from_word(DepthFrom from) {
  return std::find_if(words.begin(), words.end(), [&](const Word& known) { return known.from == from; })
      ->word;
}

std::vector<float> read_depth_file(const std::string& path, int columns, int rows) {
  if (path.ends_with(".npy")) return read_npy_depth(path, columns, rows);
  if (path.ends_with(".exr")) return read_exr_depth(path, columns, rows);
  throw InputError(path, "a depth map is a .npy of rows and columns, or an .exr with a channel Z, in metres");
}

DepthRange depth_range(const Scene& scene) {
  if (scene.depth_m.empty()) throw InputError(scene.name, "has no depth map");
  DepthRange range{std::numeric_limits<double>::infinity(), 0, 0};
  for (const float depth : scene.depth_m) {
    if (depth == 0 || std::isinf(depth)) {
      ++range.empty;
      continue;
    }
    range.least_m = std::min<double>(range.least_m, depth);
    range.greatest_m = std::max<double>(range.greatest_m, depth);
  }
  if (range.empty == scene.depth_m.size()) range.greatest_m = range.least_m;
  return range;
}

double middle_depth_m(const Scene& scene) {
  if (scene.depth_m.empty()) throw InputError(scene.name, "has no depth map");
  const auto about_middle = [](int count) {
    const int half = count / 10;
    return std::pair{(count - 1) / 2 - half, count / 2 + half};
  };
  const auto [left, right] = about_middle(scene.columns());
  const auto [top, bottom] = about_middle(scene.rows());
  std::vector<float> depths;
  for (int row = top; row <= bottom; ++row)
    for (int column = left; column <= right; ++column) {
      const float depth =
          scene.depth_m[static_cast<std::size_t>(row) * static_cast<std::size_t>(scene.columns()) +
                        static_cast<std::size_t>(column)];
      depths.push_back(depth == 0 ? std::numeric_limits<float>::infinity() : depth);
    }
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return double(*middle);
}

}  // namespace petzval
