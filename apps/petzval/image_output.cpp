// SPDX-License-Identifier: BSD-3-Clause
#include "image_output.h"

#include "field_option.h"
#include "option_names.h"
#include "raw_levels.h"

#include <fmt/format.h>
#include <petzval/base/file_extension.h>
#include <petzval/base/staged_files.h>

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace petzval::app {

namespace {

std::string distance_of(const Scene& scene) {
  return scene.distance_m() ? fmt::format("{:g} m from the sensor", *scene.distance_m()) : "at infinity";
}

}  // namespace

std::optional<NpyBandFile> large_file(const std::vector<std::string>& outputs, const ImagePlan& plan) {
  const auto& [columns, rows, pitch_um] = plan.frame;
  const Scene& scene = plan.scene;
  if (plan.depth || plan.options.flare.any() || outputs.size() != 1 ||
      extension_of(outputs.front()) != ".npy")
    return {};
  SpectralImage::check(columns, rows, scene.wavelengths_nm(), pitch_um);
  const NpyImageShape shape = {static_cast<std::size_t>(rows), static_cast<std::size_t>(columns),
                               static_cast<std::size_t>(scene.bands())};
  if (!is_large_npy(shape)) return {};
  NpyBandFile file(outputs.front(), shape);
  return file ? std::optional(std::move(file)) : std::nullopt;
}

Outputs write_image(const std::vector<std::string>& paths, const FlareChoice& flare, FormedImage& image,
                    const std::optional<Sensor>& sensor, const OutputOptions& options,
                    const Context& context) {
  StagedFiles files;
  Outputs made;
  if (image.file)
    image.file->put_at(files.stage(paths.front()));
  else
    made = write_outputs(*std::move(image.light), paths, sensor, options, files, context);
  if (image.report.flare) flare.write(*image.report.flare, files);
  files.commit();
  return made;
}

namespace {

std::vector<std::string> notes_of(const FormedImage& image) {
  std::vector<std::string> notes;
  for (const std::string& note : image.report.imaging.notes) notes.push_back(with_option_names(note));
  return notes;
}

}  // namespace

nlohmann::ordered_json summary_json(const FormedImage& image, const Outputs& made,
                                    const std::vector<std::string>& outputs) {
  nlohmann::ordered_json json = {
      {"columns", image.plan.frame.columns},
      {"rows", image.plan.frame.rows},
      {"pitch_um", image.plan.frame.pitch_um},
      {"wavelengths_nm", image.plan.scene.wavelengths_nm()},
      {"scene", image.plan.scene.name},
      {"scene_angle_deg", image.plan.scene.horizontal_angle_deg()},
      {"scene_distance_m", number_or_null(image.plan.scene.distance_m().value_or(INFINITY))},
      {"lens", image.plan.table.lens_name},
      {"working_f_number", number_or_null(image.plan.table.first_order.working_f_number)},
      {"method", image.report.method},
      {"margin_cells", image.report.imaging.margin_cells},
      {"scene_points_per_cell",
       image.report.imaging.scene_points_per_cell * image.report.imaging.scene_points_per_cell},
      {"least_captured", image.report.imaging.least_captured},
      {"irradiance_unit", "W.m^-2.nm^-1"},
      {"irradiance_min", image.report.imaging.darkest},
      {"irradiance_max", image.report.imaging.brightest},
      {"cells_per_pixel", image.report.imaging.cells_per_pixel},
      {"estimated_error", image.report.imaging.estimated_error()},
      {"tail_pixels", image.report.imaging.tail_pixels},
      {"distortion_seconds", image.report.imaging.distortion_seconds},
      {"blur_seconds", image.report.imaging.blur_seconds},
      {"kernel_seconds", image.report.imaging.kernel_seconds},
      {"notes", notes_of(image)},
      {"outputs", outputs}};
  if (made.raw) {
    json["exposure_s"] = made.raw->exposure_s;
    json["iso"] = made.raw->iso;
    json["as_shot_neutral"] = made.raw->as_shot_neutral;
    json["levels"] = levels_json(*made.raw);
  }
  if (made.picture) {
    json["temperature_k"] = made.picture->report.temperature_k;
    json["defects_corrected"] = made.picture->report.defects;
  }
  if (image.report.flare) json["flare"] = flare_json(*image.report.flare);
  if (image.report.layers.empty()) return json;
  json["viewpoint_to_sensor_mm"] = image.report.pupil_to_sensor_mm;
  for (const DepthLayer& layer : image.report.layers)
    json["layers"].push_back({{"distance_m", number_or_null(layer.distance_m.value_or(INFINITY))},
                              {"blur_um", layer.blur_um},
                              {"share", layer.share}});
  return json;
}

namespace {

void print_shot(const Outputs& made) {
  fmt::print("  exposure    {:.4g} s, ISO {:.0f}, on {}\n", made.raw->exposure_s, made.raw->iso,
             made.raw->sensor_name);
  print_levels(*made.raw);
  if (made.picture && made.raw->channels.size() > 1)
    fmt::print("  developed   white {:.4f}, {} defects corrected\n",
               fmt::join(made.picture->report.neutral, " "), made.picture->report.defects);
}

void print_layers(const std::vector<DepthLayer>& layers, double pitch_um) {
  if (layers.empty()) return;
  const auto end = [&](const DepthLayer& layer) {
    return fmt::format("{} (blur {:.3g} pixels)",
                       layer.distance_m ? fmt::format("{:.4g} m", *layer.distance_m) : "infinity",
                       std::abs(layer.blur_um) / pitch_um);
  };
  if (layers.size() == 1) return fmt::print("  depth       1 layer, {}\n", end(layers.front()));
  fmt::print("  depth       {} layers from {} to {}\n", layers.size(), end(layers.back()),
             end(layers.front()));
}

}  // namespace

void print_summary(const FormedImage& image, const Outputs& made) {
  const auto& bands = image.plan.scene.wavelengths_nm();
  fmt::print("{} x {} pixels of {:.5g} um, ", image.plan.frame.columns, image.plan.frame.rows,
             image.plan.frame.pitch_um);
  if (bands.size() == 1)
    fmt::print("1 band at {:g} nm\n", bands.front());
  else
    fmt::print("{} bands from {:g} to {:g} nm\n", bands.size(), bands.front(), bands.back());
  fmt::print("  scene       {}, {:.4g} degrees wide, {}\n", image.plan.scene.name,
             image.plan.scene.horizontal_angle_deg(), distance_of(image.plan.scene));
  fmt::print("  lens        {}, working f-number {:.4g}\n", image.plan.table.lens_name,
             image.plan.table.first_order.working_f_number);
  fmt::print("  method      {}\n", image.report.method);
  fmt::print("  irradiance  {:.4g} to {:.4g} W/(m2 nm)\n", image.report.imaging.darkest,
             image.report.imaging.brightest);
  if (image.report.flare) print_flare(*image.report.flare);
  if (made.raw) print_shot(made);
  print_layers(image.report.layers, image.plan.frame.pitch_um);
}

}  // namespace petzval::app
