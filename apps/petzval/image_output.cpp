// SPDX-License-Identifier: BSD-3-Clause
#include "image_output.h"

#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/file_extension.h>
#include <petzval/base/staged_files.h>
#include <petzval/image/formats/irradiance.h>
#include <petzval/image/picture.h>

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace petzval::app {

std::string method_text(const ImagingOptions& options, const ImagingReport& report) {
  if (options.method == BlurMethod::none) return "distortion and illumination, no blur";
  const std::string between = options.interpolation == PsfInterpolation::otf ? "OTFs" : "PSFs";
  if (options.method == BlurMethod::exact)
    return fmt::format("exact, every cell its own PSF; {} interpolated", between);
  if (options.method == BlurMethod::product) {
    const ProductPlan& plan = report.product;
    const std::string rim = plan.exact.empty()
                                ? ""
                                : fmt::format("every cell its own PSF {:.0f} to {:.0f} cells from the axis, ",
                                              plan.exact.from, plan.exact.to);
    const std::string error = fmt::format("{}estimated error {:.1e} of {:g}; {} interpolated", rim,
                                          plan.estimated_error, options.product.tolerance, between);
    if (plan.direct)
      return fmt::format("product, {0} x {0} nodes in tiles of {1} x {1} cells, gathered, {2}", plan.nodes,
                         plan.tile, error);
    if (plan.transform == 0) return fmt::format("blended sections of {0} x {0} cells, {1}", plan.tile, error);
    return fmt::format("product, {0} x {0} nodes in tiles of {1} x {1} cells, transforms of {2} x {2}, {3}",
                       plan.nodes, plan.tile, plan.transform, error);
  }
  return fmt::format("{3}sections of {0} x {0} cells, transforms of {1} x {1}; {2} interpolated",
                     options.sections.section, report.transform_size, between,
                     options.method == BlurMethod::blended ? "blended " : "");
}

std::string distance_text(const Scene& scene) {
  return scene.distance_m() ? fmt::format("{:g} m from the sensor", *scene.distance_m()) : "at infinity";
}

namespace {

/// The white of the scene, if its light in these bands can be taken for white at all: two or three narrow
/// bands cannot.
std::optional<Spectrum> usable_white(const SpectralImage& image, const Scene& scene, const Shared& shared) {
  const SpectralImage one_pixel(1, 1, image.wavelengths_nm(), image.pitch_um());
  PictureOptions options;
  options.scene_white = scene.illuminant;
  try {
    PictureRenderer(one_pixel, options);
    return scene.illuminant;
  } catch (const InputError& error) {
    note(shared,
         fmt::format("colours are shown as they fall on the sensor, not adapted to white: {}", error.what()));
    return {};
  }
}

}  // namespace

std::optional<NpyBandFile> large_file(const std::vector<std::string>& outputs, const SensorGeometry& frame,
                                      const Scene& scene) {
  if (outputs.size() != 1 || extension_of(outputs.front()) != ".npy") return {};
  SpectralImage::check(frame.columns, frame.rows, scene.wavelengths_nm(), frame.pitch_um);
  const NpyImageShape shape = {static_cast<std::size_t>(frame.rows), static_cast<std::size_t>(frame.columns),
                               static_cast<std::size_t>(scene.bands())};
  if (!is_large_npy(shape)) return {};
  NpyBandFile file(outputs.front(), shape);
  return file ? std::optional(std::move(file)) : std::nullopt;
}

std::optional<Shot> write_outputs(const ImageChoice& choice, FormedImage& image,
                                  const std::optional<Sensor>& sensor, const Shared& shared) {
  StagedFiles files;
  if (image.file) {
    image.file->put_at(files.stage(choice.outputs.front()));
    files.commit();
    return {};
  }
  SpectralImage& light = *image.light;
  std::vector<std::string> of_light;
  for (const std::string& path : choice.outputs) {
    const std::string extension = extension_of(path);
    if (extension == ".exr" || extension == ".npy") {
      of_light.push_back(path);
    } else if (extension == ".png" && !choice.shot.develops(sensor)) {
      PictureOptions options;
      options.scene_white = usable_white(light, image.scene, shared);
      options.false_colour = true;
      note(shared,
           fmt::format("{}: {}", path, write_picture(files.stage(path), light, options, choice.shot.bits)));
    }
  }
  std::optional<Shot> shot = choice.shot.shoot(light, sensor, choice.outputs, files, shared);
  // Whole images come last: the last of them may use the room that the light takes.
  for (std::size_t i = 0; i < of_light.size(); ++i) {
    const std::string staged = files.stage(of_light[i]);
    if (i + 1 < of_light.size())
      write_irradiance(staged, light);
    else
      write_irradiance(staged, std::move(light));
  }
  files.commit();
  return shot;
}

nlohmann::ordered_json summary_json(const FormedImage& image, const std::optional<Shot>& shot,
                                    const std::vector<std::string>& outputs) {
  nlohmann::ordered_json json = {
      {"columns", image.frame.columns},
      {"rows", image.frame.rows},
      {"pitch_um", image.frame.pitch_um},
      {"wavelengths_nm", image.scene.wavelengths_nm()},
      {"scene", image.scene.name},
      {"scene_angle_deg", image.scene.horizontal_angle_deg()},
      {"scene_distance_m", number_or_null(image.scene.distance_m().value_or(INFINITY))},
      {"lens", image.table.lens_name},
      {"working_f_number", number_or_null(image.table.first_order.working_f_number)},
      {"method", image.method},
      {"margin_cells", image.report.margin_cells},
      {"scene_points_per_cell", image.report.scene_points_per_cell * image.report.scene_points_per_cell},
      {"least_captured", image.report.least_captured},
      {"irradiance_unit", "W.m^-2.nm^-1"},
      {"irradiance_min", image.report.darkest},
      {"irradiance_max", image.report.brightest},
      {"estimated_error", image.report.product.estimated_error},
      {"distortion_seconds", image.report.distortion_seconds},
      {"blur_seconds", image.report.blur_seconds},
      {"kernel_seconds", image.report.kernel_seconds},
      {"notes", image.report.notes},
      {"outputs", outputs}};
  if (shot) {
    json["exposure_s"] = shot->raw.exposure_s;
    json["iso"] = shot->raw.iso;
    json["as_shot_neutral"] = shot->raw.as_shot_neutral;
  }
  if (shot && shot->development) {
    json["temperature_k"] = shot->development->temperature_k;
    json["defects_corrected"] = shot->development->defects;
  }
  return json;
}

void print_summary(const FormedImage& image, const std::optional<Shot>& shot) {
  const auto& bands = image.scene.wavelengths_nm();
  fmt::print("{} x {} pixels of {:.5g} um, ", image.frame.columns, image.frame.rows, image.frame.pitch_um);
  if (bands.size() == 1)
    fmt::print("1 band at {:g} nm\n", bands.front());
  else
    fmt::print("{} bands from {:g} to {:g} nm\n", bands.size(), bands.front(), bands.back());
  fmt::print("  scene       {}, {:.4g} degrees wide, {}\n", image.scene.name,
             image.scene.horizontal_angle_deg(), distance_text(image.scene));
  fmt::print("  lens        {}, working f-number {:.4g}\n", image.table.lens_name,
             image.table.first_order.working_f_number);
  fmt::print("  method      {}\n", image.method);
  fmt::print("  irradiance  {:.4g} to {:.4g} W/(m2 nm)\n", image.report.darkest, image.report.brightest);
  if (!shot) return;
  fmt::print("  exposure    {:.4g} s, ISO {:.0f}, on {}\n", shot->raw.exposure_s, shot->raw.iso,
             shot->raw.sensor_name);
  if (shot->development && shot->raw.channels.size() > 1)
    fmt::print("  developed   white {:.4f}, {} defects corrected\n",
               fmt::join(shot->development->neutral, " "), shot->development->defects);
}

}  // namespace petzval::app
