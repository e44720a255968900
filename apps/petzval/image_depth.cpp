// SPDX-License-Identifier: BSD-3-Clause
#include "image_depth.h"

#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/lens/first_order.h>
#include <petzval/scene/depth_map.h>

#include <cmath>

#include "field_option.h"

namespace petzval::app {

void add_depth_options(CLI::App& command, DepthOptions& options) {
  command.add_option("--layers", options.layers,
                     "Layers that a scene with depth is cut into; 0: as many as its defocus needs");
}

void check_depth(const Scene& scene, bool used, const DepthOptions& options, const Shared& shared) {
  options.validate();
  if (!used && options.layers != 0)
    throw InputError("--layers is for scenes with depth; this one is a plane (--scene-depth gives it a map)");
  if (!used && !scene.depth_m.empty())
    note(
        shared,
        "the scene's depth map is not used: a lens data table is made for one distance; --lens would use it");
}

namespace {

std::optional<double> middle_from_sensor_m(const Scene& scene, MountedLens& camera) {
  const double depth_m = middle_depth_m(scene);
  if (std::isinf(depth_m)) return std::nullopt;
  if (scene.depth_from == DepthFrom::sensor) return depth_m;
  // The pupil stays as far from the lens as it is; the sensor moves by less and less.
  double focus_m = depth_m;
  constexpr int rounds = 4;
  for (int round = 0; round < rounds; ++round) {
    focus_m = depth_m + DefocusLaw(camera.lens()).pupil_to_sensor_mm() / mm_per_m;
    camera.focus_at_m(focus_m);
  }
  return focus_m;
}

}  // namespace

std::optional<double> depth_focus_m(const Scene& scene, MountedLens camera) {
  try {
    const std::optional<double> middle_m = middle_from_sensor_m(scene, camera);
    camera.focus_at_m(middle_m);
    return middle_m;
  } catch (const InputError& error) {
    throw InputError(
        fmt::format("the depth in the middle of the picture is {:.4g} m: {} (--focus takes another "
                    "distance; --scene-depth-scale is for maps in other units than metres)",
                    middle_depth_m(scene), error.what()));
  }
}

double depth_image_height_mm(const Scene& scene, const Lens& lens,
                             const std::optional<SensorGeometry>& sensor) {
  if (sensor) return sensor->half_diagonal_mm();
  return natural_depth_pitch_um(scene, lens) * mm_per_um * std::hypot(scene.columns(), scene.rows()) / 2;
}

LensDataTable facts_alone(const Lens& lens) {
  LensDataTable table;
  table.lens_name = lens.name;
  table.first_order = first_order(lens);
  return table;
}

nlohmann::ordered_json with_layers(nlohmann::ordered_json summary, const DepthReport& report) {
  if (report.layers.empty()) return summary;
  summary["viewpoint_to_sensor_mm"] = report.pupil_to_sensor_mm;
  for (const DepthLayer& layer : report.layers)
    summary["layers"].push_back({{"distance_m", number_or_null(layer.distance_m.value_or(INFINITY))},
                                 {"blur_um", layer.blur_um},
                                 {"share", layer.share}});
  return summary;
}

void print_layers(const DepthReport& report, double pitch_um) {
  if (report.layers.empty()) return;
  const auto end = [&](const DepthLayer& layer) {
    return fmt::format("{} (blur {:.3g} pixels)",
                       layer.distance_m ? fmt::format("{:.4g} m", *layer.distance_m) : "infinity",
                       std::abs(layer.blur_um) / pitch_um);
  };
  if (report.layers.size() == 1) return fmt::print("  depth       1 layer, {}\n", end(report.layers.front()));
  fmt::print("  depth       {} layers from {} to {}\n", report.layers.size(), end(report.layers.back()),
             end(report.layers.front()));
}

}  // namespace petzval::app
