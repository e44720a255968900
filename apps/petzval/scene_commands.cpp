// SPDX-License-Identifier: BSD-3-Clause
// petzval scene list | info | convert
#include "command.h"
#include "depth_picture.h"
#include "field_option.h"
#include "output_option.h"
#include "scene_list.h"
#include "scene_option.h"

#include <fmt/format.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/error.h>
#include <petzval/base/file_extension.h>
#include <petzval/image/picture.h>
#include <petzval/scene/depth_map.h>
#include <petzval/scene/formats/scene_exr.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>

namespace petzval::app {

using nlohmann::ordered_json;

namespace {

void list_scenes(const Shared& shared) {
  ordered_json rows = ordered_json::array();
  for (const BuiltinScene& scene : builtin_scenes())
    rows.push_back({{"name", scene.name}, {"kind", "chart"}, {"description", scene.description}});
  for (const char* extension : {".exr", ".mat"})
    for (const std::string& name : bundled_names("scenes", extension))
      rows.push_back(
          {{"name", name}, {"kind", "file"}, {"description", std::string("bundled ") + (extension + 1)}});
  for (ordered_json row : rows_of_worlds()) {
    row["description"] = row["description"].get<std::string>() + " (for petzval render)";
    rows.push_back(row);
  }
  print_scenes(rows, shared.json);
}

struct RadianceRange {
  float least = std::numeric_limits<float>::infinity(), greatest = 0;
};

RadianceRange radiance_range(const Scene& scene) {
  RadianceRange range;
  for (int index = 0; index < scene.bands(); ++index) {
    const std::span<const float> band = scene.band(index);
    const auto [least, greatest] = std::minmax_element(band.begin(), band.end());
    range = {std::min(range.least, *least), std::max(range.greatest, *greatest)};
    scene.release_memory();
  }
  return range;
}

ordered_json facts(const Scene& scene) {
  const RadianceRange range = radiance_range(scene);
  ordered_json json;
  json["name"] = scene.name;
  json["columns"] = scene.columns();
  json["rows"] = scene.rows();
  json["bands"] = scene.bands();
  json["wavelengths_nm"] = scene.wavelengths_nm();
  json["horizontal_angle_deg"] = scene.horizontal_angle_deg();
  json["vertical_angle_deg"] = scene.vertical_angle_deg();
  json["diagonal_angle_deg"] = scene.diagonal_angle_deg();
  json["distance_m"] = scene.distance_m() ? ordered_json(*scene.distance_m()) : ordered_json(nullptr);
  json["mean_luminance_cd_m2"] = scene.mean_luminance_cd_m2();
  json["min_radiance"] = range.least;
  json["max_radiance"] = range.greatest;
  json["mean_radiance"] = scene.mean_radiance();
  json["radiance_unit"] = "W.m^-2.sr^-1.nm^-1";
  json["has_illuminant"] = scene.illuminant.has_value();
  json["has_depth"] = !scene.depth_m.empty();
  if (!scene.depth_m.empty()) {
    const DepthRange range = depth_range(scene);
    json["depth_min_m"] = number_or_null(range.least_m);
    json["depth_max_m"] = number_or_null(range.greatest_m);
    json["depth_from"] = depth_from_word(scene.depth_from);
    json["depth_empty_samples"] = range.empty;
  }
  return json;
}

void print_facts(const Scene& scene) {
  const ordered_json json = facts(scene);
  const auto& bands = scene.wavelengths_nm();
  fmt::print("{}\n", scene.name);
  fmt::print("  samples         {} x {}\n", scene.columns(), scene.rows());
  fmt::print("  bands           {} from {:g} to {:g} nm\n", bands.size(), bands.front(), bands.back());
  fmt::print("  angle           {:.4g} x {:.4g} degrees, diagonal {:.4g}\n", scene.horizontal_angle_deg(),
             scene.vertical_angle_deg(), scene.diagonal_angle_deg());
  fmt::print("  distance        {}\n",
             scene.distance_m() ? fmt::format("{:g} m", *scene.distance_m()) : "infinity");
  fmt::print("  mean luminance  {:.5g} cd/m2 in these bands\n", scene.mean_luminance_cd_m2());
  fmt::print("  radiance        {:.4g} to {:.4g} W/(m2 sr nm)\n", json["min_radiance"].get<double>(),
             json["max_radiance"].get<double>());
  fmt::print("  illuminant      {}\n", scene.illuminant ? "known" : "unknown");
  fmt::print("  depth           {}\n", depth_text(scene));
}

/// The scene as if it were an image of itself, for the eye.
void write_scene_picture(const std::string& path, const Scene& scene) {
  SpectralImage image(scene.columns(), scene.rows(), scene.wavelengths_nm(), 1);
  for (int band = 0; band < scene.bands(); ++band)
    std::copy(scene.band(band).begin(), scene.band(band).end(), image.band(band).begin());
  image.provenance = fmt::format("radiance of the scene {}", scene.name);
  PictureOptions options;
  options.scene_white = scene.illuminant;
  options.monochrome_in_colour = true;
  options.false_colour = true;
  write_picture(path, image, options);
}

void convert_scene(const SceneChoice& choice, const std::string& out, bool depth, const Shared& shared) {
  if (depth) return write_depth(out, choice.read(shared), shared);
  const std::string extension = extension_of(out);
  if (extension != ".exr" && extension != ".png")
    throw InputError(out, "a scene is written as .exr or, to look at, .png");
  const Scene scene = choice.read(shared);
  if (extension == ".exr")
    write_scene_exr(out, scene);
  else
    write_scene_picture(out, scene);
}

}  // namespace

void add_scene_commands(CLI::App& app, Shared& shared) {
  CLI::App* scene = app.add_subcommand("scene", "Scenes: charts, photographs, ISET files, spectral OpenEXR");
  scene->require_subcommand(1);

  add_command(*scene, shared, "list", "List the scenes known by name", "petzval scene list", true,
              [&shared] { list_scenes(shared); });

  auto info = std::make_shared<SceneChoice>();
  info->add_to(*add_command(*scene, shared, "info", "Say what a scene is", "petzval scene info studio --json",
                            true, [&shared, info] {
                              const Scene read = info->read(shared);
                              if (shared.json) return fmt::print("{}\n", facts(read).dump(2));
                              print_facts(read);
                            }));

  auto convert = std::make_shared<SceneChoice>();
  auto out = std::make_shared<std::string>();
  auto depth = std::make_shared<bool>(false);
  CLI::App* command =
      add_command(*scene, shared, "convert", "Write a scene as spectral OpenEXR or as a picture",
                  "petzval scene convert checkerboard:24 --scene-size 1024x768 board.exr", false,
                  [&shared, convert, out, depth] { convert_scene(*convert, *out, *depth, shared); });
  convert->add_to(*command);
  command->add_option("out", *out, "OUT.exr or OUT.png")->check(output_file())->required();
  command->add_flag("--depth", *depth,
                    "Write the depth map instead: OUT.png in false colours, or OUT.npy [m]");
}

}  // namespace petzval::app
