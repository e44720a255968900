// SPDX-License-Identifier: BSD-3-Clause
#include "depth_picture.h"

#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/colour/colour_map.h>
#include <petzval/image/formats/npy.h>
#include <petzval/image/formats/png.h>
#include <petzval/scene/depth_map.h>

#include <algorithm>
#include <cmath>

namespace petzval::app {

namespace {

const char* origin_text(DepthFrom from) {
  return from == DepthFrom::sensor  ? "from the sensor"
         : from == DepthFrom::pupil ? "from the entrance pupil"
                                    : "from the entrance pupil, along lines of sight";
}

/// Dioptres; 0 where nothing is.
double dioptres(float depth_m) {
  return depth_m == 0 ? 0 : 1 / double(depth_m);
}

void write_depth_png(const std::string& path, const Scene& scene, const Shared& shared) {
  const DepthRange range = depth_range(scene);
  const double near = 1 / range.least_m, far = range.empty > 0 ? 0 : 1 / range.greatest_m;
  const std::array<Rgb8, 256> colours = colour_table(ColourMap::inferno);
  PngLayout layout;
  layout.columns = scene.columns();
  layout.rows = scene.rows();
  layout.text["Description"] = fmt::format("depth of {}, {}: bright is near", scene.name, depth_text(scene));
  const auto width = static_cast<std::size_t>(scene.columns());
  write_png(path, layout, [&](int row, std::span<std::uint16_t> samples) {
    for (std::size_t column = 0; column < width; ++column) {
      const double here = dioptres(scene.depth_m[static_cast<std::size_t>(row) * width + column]);
      const double t = near > far ? (here - far) / (near - far) : 1;
      const Rgb8 colour = colours[static_cast<std::size_t>(std::lround(255 * std::clamp(t, 0.0, 1.0)))];
      samples[3 * column] = colour.r;
      samples[3 * column + 1] = colour.g;
      samples[3 * column + 2] = colour.b;
    }
  });
  note(shared, fmt::format("{}: false colours, even in dioptres, from {} (dark) to {:.4g} m (bright)", path,
                           far > 0 ? fmt::format("{:.4g} m", 1 / far) : "infinity", range.least_m));
}

}  // namespace

std::string depth_text(const Scene& scene) {
  if (scene.depth_m.empty()) return "none";
  const DepthRange range = depth_range(scene);
  if (range.empty == scene.depth_m.size()) return "infinity everywhere";
  std::string text =
      fmt::format("{:.4g} to {:.4g} m {}", range.least_m, range.greatest_m, origin_text(scene.depth_from));
  if (range.empty > 0) text += fmt::format(", nothing in {} samples", range.empty);
  return text;
}

void write_depth(const std::string& path, const Scene& scene, const Shared& shared) {
  require_extension(path, {".png", ".npy"}, "a depth map");
  if (scene.depth_m.empty()) throw InputError(scene.name, "has no depth map; --scene-depth gives it one");
  if (path.ends_with(".png")) return write_depth_png(path, scene, shared);
  write_npy(path,
            std::vector<std::size_t>{static_cast<std::size_t>(scene.rows()),
                                     static_cast<std::size_t>(scene.columns())},
            scene.depth_m);
}

}  // namespace petzval::app
