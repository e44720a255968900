// SPDX-License-Identifier: BSD-3-Clause
#include "render_output.h"

#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/file_extension.h>
#include <petzval/base/units.h>
#include <petzval/image/formats/npy.h>
#include <petzval/image/formats/spectral_exr.h>
#include <petzval/simulate/scene_segments.h>
#include <petzval/simulate/scene_truth.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>

#include "command.h"
#include "field_option.h"
#include "output_option.h"
#include "raw_levels.h"

namespace petzval::app {

namespace {

constexpr std::size_t most_groups_checked = 1000;

/// "lamp-3.exr" of "lamp.exr".
std::string group_path(const std::string& pattern, std::size_t light) {
  const std::filesystem::path path(pattern);
  return (path.parent_path() / fmt::format("{}-{}{}", path.stem().string(), light, path.extension().string()))
      .string();
}

/// Whether `path` may be one of these.
bool is_group_name(const std::string& pattern, const std::string& path) {
  for (std::size_t i = 0; i < most_groups_checked; ++i)
    if (std::filesystem::path(group_path(pattern, i)).lexically_normal() ==
        std::filesystem::path(path).lexically_normal())
      return true;
  return false;
}

/// Planes of bands as numbers of pixels, the order that irradiance is written in.
std::vector<float> bands_last(const std::vector<float>& planes, std::size_t bands) {
  const std::size_t pixels = planes.size() / bands;
  std::vector<float> result(planes.size());
  for (std::size_t band = 0; band < bands; ++band)
    for (std::size_t i = 0; i < pixels; ++i) result[i * bands + band] = planes[band * pixels + i];
  return result;
}

/// Channels of an .exr, as Blender and Nuke call depth and normals; reflectance as spectral layouts have it.
struct Layers {
  std::vector<std::vector<float>> values;
  std::vector<std::string> names;

  void add(std::string name, std::vector<float> plane) {
    names.push_back(std::move(name));
    values.push_back(std::move(plane));
  }
  std::vector<ExrPlane> planes() const {
    std::vector<ExrPlane> result;
    for (std::size_t i = 0; i < names.size(); ++i) result.push_back({names[i], values[i]});
    return result;
  }
};

Layers layers_of(const Rendering& picture) {
  const render::FirstSurfaces& first = *picture.first_surfaces;
  const std::size_t pixels = first.depth.size();
  Layers layers;
  layers.add(exr_depth_channel, first.depth);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<float> plane(pixels);
    for (std::size_t i = 0; i < pixels; ++i) plane[i] = first.normal[3 * i + axis];
    layers.add(std::string("N.") + "XYZ"[axis], std::move(plane));
  }
  const std::vector<double>& nm = picture.irradiance.wavelengths_nm();
  for (std::size_t band = 0; band < nm.size(); ++band) {
    const auto from = first.albedo.begin() + static_cast<std::ptrdiff_t>(band * pixels);
    layers.add(spectral_channel_name({SpectralChannel::Kind::reflective, 0, nm[band]}),
               std::vector<float>(from, from + static_cast<std::ptrdiff_t>(pixels)));
  }
  return layers;
}

void write_first_surfaces(const RenderOutputs& outputs, const Rendering& picture, StagedFiles& files) {
  const auto rows = static_cast<std::size_t>(picture.irradiance.rows());
  const auto columns = static_cast<std::size_t>(picture.irradiance.columns());
  const auto bands = static_cast<std::size_t>(picture.irradiance.bands());
  if (!outputs.depth.empty())
    write_npy(files.stage(outputs.depth), std::vector<std::size_t>{rows, columns},
              picture.first_surfaces->depth);
  if (!outputs.normals.empty())
    write_npy(files.stage(outputs.normals), std::vector<std::size_t>{rows, columns, 3},
              picture.first_surfaces->normal);
  if (!outputs.albedo.empty())
    write_npy(files.stage(outputs.albedo), std::vector<std::size_t>{rows, columns, bands},
              bands_last(picture.first_surfaces->albedo, bands));
}

void write_segments(const std::string& path, const SceneSegments& seen, StagedFiles& files) {
  std::vector<float> values;
  values.reserve(3 * seen.shape.size());
  for (std::size_t i = 0; i < seen.shape.size(); ++i)
    for (const std::vector<int>* each : {&seen.shape, &seen.instance, &seen.material})
      values.push_back(static_cast<float>((*each)[i]));
  write_npy(files.stage(path),
            std::vector<std::size_t>{static_cast<std::size_t>(seen.rows),
                                     static_cast<std::size_t>(seen.columns), 3},
            values);
}

}  // namespace

void RenderOutputs::add_to(CLI::App& command) {
  command
      .add_option(
          "--depth", depth,
          "Also write the distance along the axis of what is seen from the film [scene units], infinity "
          "where nothing is: rows x columns (.npy)")
      ->check(output_file());
  command
      .add_option("--normals", normals, "Also write its normals in world space: rows x columns x 3 (.npy)")
      ->check(output_file());
  command.add_option("--albedo", albedo, "Also write its reflectance: rows x columns x bands (.npy)")
      ->check(output_file());
  command
      .add_option(
          "--segments", segments,
          "Also write which shape, placed object and material the middle of each pixel sees, by their "
          "number in the scene, -1 for none: rows x columns x 3 (.npy)")
      ->check(output_file());
  command
      .add_option(
          "--flow", flow,
          "Also write how far what the middle of each pixel sees moves to the right and down in the picture, "
          "from the beginning of its exposure to the end, with --camera-move or --look-move: rows x columns "
          "x 2 [pixels] (.npy)")
      ->check(output_file());
  command
      .add_option("--light-groups", light_groups,
                  "Also write what each light gives of the light; the sum is the whole. lamp.exr becomes "
                  "lamp-0.exr, lamp-1.exr, ..., by the numbers that --light has (.exr, .npy)")
      ->check(output_file());
  command.add_flag(
      "--layers", layers,
      "Every .exr of the light also has depth (Z), normals (N.X, N.Y, N.Z) and reflectance (T.550,0nm)");
  flare.add_to(command, false);
  command
      .add_option("-o,--output", pictures,
                  "Irradiance as .exr or .npy, what --sensor makes of it as .dng, a picture as .png or .tif; "
                  "repeatable")
      ->check(output_file())
      ->allow_extra_args(false);
  shot.add_to(command);
  shot.add_display_to(command);
  command
      .add_option("--illuminant", shot.sense.illuminant,
                  "Light of the scene, for white balance; default: as it falls on what is seen")
      ->group("Exposure of the sensor");
}

OutputOptions RenderOutputs::checked(const std::optional<Sensor>& sensor, const CLI::App& command) const {
  if (pictures.empty())
    throw InputError("-o names the picture to be written (.exr, .npy, .png; with a --sensor .dng and .tif)");
  for (const std::string& path : pictures)
    require_extension(path, {".exr", ".npy", ".dng", ".png", ".tif", ".tiff"}, "a rendering");
  if (layers && std::ranges::none_of(pictures, [](const auto& path) { return extension_of(path) == ".exr"; }))
    throw InputError("--layers are written beside the light: -o picture.exr would be right");
  if (!light_groups.empty()) {
    require_extension(light_groups, {".exr", ".npy"}, "the light of one lamp");
    if (flare.options().any())
      throw InputError(
          "--light-groups: ghosts, suns and starbursts belong to no light of the scene; one of them without "
          "the other "
          "would be right");
    for (const std::string& path : pictures)
      if (is_group_name(light_groups, path))
        throw InputError(fmt::format("-o {} and --light-groups {} write the same file", path, light_groups));
  }
  for (const std::string* path : {&depth, &normals, &albedo, &segments, &flow})
    if (!path->empty()) require_extension(*path, {".npy"}, "a picture of first surfaces");
  return shot.checked(sensor, pictures, command);
}

void RenderOutputs::keep_off(const std::vector<std::string>& files_of_scene,
                             const std::vector<std::pair<std::string, std::string>>& others) const {
  std::vector<NamedFile> outputs, inputs;
  for (const std::string& path : pictures) outputs.push_back({"--output", path});
  for (const auto& [option, path] :
       {NamedFile{"--depth", depth}, NamedFile{"--normals", normals}, NamedFile{"--albedo", albedo},
        NamedFile{"--segments", segments}, NamedFile{"--flow", flow},
        NamedFile{"--ghost-layer", flare.ghost_layer}, NamedFile{"--scatter-layer", flare.scatter_layer}})
    if (!path.empty()) outputs.push_back({option, path});
  // Only what is there already can be a file of the scene.
  for (std::size_t i = 0; !light_groups.empty() && i < most_groups_checked; ++i)
    if (const std::string path = group_path(light_groups, i); std::filesystem::exists(path))
      outputs.push_back({"--light-groups", path});
  for (const auto& [option, path] : others)
    if (!path.empty()) outputs.push_back({option, path});
  for (const std::string& path : files_of_scene) inputs.push_back({"scene", path});
  refuse_same_files(outputs, inputs);
}

Outputs RenderOutputs::write(const Rendering& picture, const PreparedScene& scene,
                             const std::optional<Sensor>& sensor, const OutputOptions& options,
                             const Context& context, const FlareLayers* layers_of_flare) const {
  StagedFiles files;
  const Layers beside = layers ? layers_of(picture) : Layers();
  OutputOptions all = options;
  all.layers = beside.planes();
  Outputs made = write_outputs(picture.irradiance, pictures, sensor, all, files, context);
  write_first_surfaces(*this, picture, files);
  for (std::size_t i = 0; !light_groups.empty() && i < picture.light_groups.size(); ++i)
    write_outputs(picture.light_groups[i], {group_path(light_groups, i)}, {}, {}, files, context);
  if (!segments.empty()) write_segments(segments, segments_seen(scene, context), files);
  if (!flow.empty())
    write_npy(files.stage(flow),
              std::vector<std::size_t>{static_cast<std::size_t>(picture.irradiance.rows()),
                                       static_cast<std::size_t>(picture.irradiance.columns()), 2},
              flow_seen(scene, context));
  if (layers_of_flare) flare.write(*layers_of_flare, files);
  files.commit();
  return made;
}

std::string rounded_distance_text(double distance_m) {
  if (!std::isfinite(distance_m)) return "infinity";
  return distance_m < 1 ? fmt::format("{:.3g} mm", distance_m * mm_per_m)
                        : fmt::format("{:.3g} m", distance_m);
}

std::string duration_text(double seconds) {
  constexpr double minute = 60, hour = 3600;
  if (seconds < 2 * minute) return fmt::format("{:.2g} s", seconds);
  if (seconds < 2 * hour) return fmt::format("{:.0f} min", seconds / minute);
  return fmt::format("{:.1f} h", seconds / hour);
}

namespace {

nlohmann::ordered_json framing_json(const Framing& framing) {
  return {{"film_width_mm", framing.film_width_mm},
          {"film_height_mm", framing.film_height_mm},
          {"efl_mm", framing.efl_mm},
          {"f_number", framing.f_number},
          {"working_f_number", framing.working_f_number},
          {"horizontal_field_of_view_deg", number_or_null(framing.view.width)},
          {"vertical_field_of_view_deg", number_or_null(framing.view.height)},
          {"diagonal_field_of_view_deg", number_or_null(framing.view.diagonal)},
          {"lit_circle_mm", framing.lit_circle_mm},
          {"distance_in_focus_m", number_or_null(framing.distance_m)},
          {"depth_of_field_near_m", number_or_null(framing.sharp.near_m)},
          {"depth_of_field_far_m", number_or_null(framing.sharp.far_m)}};
}

std::string angle_text(double deg) {
  return std::isfinite(deg) ? fmt::format("{:.1f}", deg) : "-";
}

void print_framing(const Framing& framing) {
  fmt::print(
      "  view     {} x {} degrees on a film of {:.4g} x {:.4g} mm; f = {:.4g} mm, f/{:.3g} (working "
      "f/{:.3g})\n",
      angle_text(framing.view.width), angle_text(framing.view.height), framing.film_width_mm,
      framing.film_height_mm, framing.efl_mm, framing.f_number, framing.working_f_number);
  fmt::print("  focus    {} from the film; sharp to a pixel from {} to {}\n",
             rounded_distance_text(framing.distance_m), rounded_distance_text(framing.sharp.near_m),
             rounded_distance_text(framing.sharp.far_m));
}

}  // namespace

nlohmann::ordered_json summary_json(const PreparedScene& scene, const Rendering& picture, const Outputs& made,
                                    const RenderSeconds& seconds, const std::vector<std::string>& outputs) {
  using Json = nlohmann::ordered_json;
  const SpectralImage& image = picture.irradiance;
  const std::span<const float> values = image.values();
  double sum = 0;
  for (const float value : values) sum += static_cast<double>(value);
  Json json = {{"scene", scene.request.scene},
               {"lens", scene.lens ? Json(scene.lens->name) : Json()},
               {"film_distance_mm", scene.lens ? Json(scene.film_distance_mm()) : Json()},
               {"columns", image.columns()},
               {"rows", image.rows()},
               {"pitch_um", image.pitch_um()},
               {"pixel_aperture", scene.photosite.text()},
               {"wavelengths_nm", image.wavelengths_nm()},
               {"samples_per_pixel", picture.samples_per_pixel},
               {"noise", picture.noise ? Json(*picture.noise) : Json()},
               {"denoised", picture.denoised},
               {"camera_rays", picture.rays},
               {"camera_rays_passed", picture.passed},
               {"mean_irradiance", sum / static_cast<double>(values.size())},
               {"irradiance_unit", "W.m^-2.nm^-1"},
               {"prepare_seconds", seconds.prepare},
               {"render_seconds", seconds.light},
               {"outputs", outputs}};
  if (scene.lens) json.update(framing_json(framing(scene)));
  if (!made.raw) return json;
  json["exposure_s"] = made.raw->exposure_s;
  json["iso"] = made.raw->iso;
  json["as_shot_neutral"] = made.raw->as_shot_neutral;
  json["levels"] = levels_json(*made.raw);
  return json;
}

void print_summary(const PreparedScene& scene, const Rendering& picture, const Outputs& made,
                   const RenderSeconds& seconds) {
  const SpectralImage& image = picture.irradiance;
  const auto& bands = image.wavelengths_nm();
  fmt::print("{} x {} pixels of {:.5g} um, ", image.columns(), image.rows(), image.pitch_um());
  if (bands.size() == 1)
    fmt::print("1 band at {:g} nm\n", bands.front());
  else
    fmt::print("{} bands from {:g} to {:g} nm\n", bands.size(), bands.front(), bands.back());
  fmt::print("  camera   {}\n", camera_text(scene));
  if (scene.lens) print_framing(framing(scene));
  fmt::print("  samples  {} a pixel; {:.1f} % of {} camera rays pass\n", picture.samples_per_pixel,
             100.0 * static_cast<double>(picture.passed) /
                 static_cast<double>(std::max<std::uint64_t>(picture.rays, 1)),
             picture.rays);
  if (picture.noise) fmt::print("  noise    {:.3g} (RMS error over mean light)\n", *picture.noise);
  if (picture.denoised) fmt::print("  denoised by non-local means of light, albedo, normals and depth\n");
  fmt::print("  time     {:.2f} s to prepare, {:.1f} s for light, {:.3g} million camera rays a second\n",
             seconds.prepare, seconds.light,
             static_cast<double>(picture.rays) * 1e-6 / std::max(seconds.light, 1e-9));
  if (!made.raw) return;
  fmt::print("  exposure {:.4g} s, ISO {:.0f}, on {}\n", made.raw->exposure_s, made.raw->iso,
             made.raw->sensor_name);
  print_levels(*made.raw);
}

}  // namespace petzval::app
