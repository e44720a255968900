// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/whole_file.h>
#include <petzval/render/pbrt/scene_files.h>

#include <filesystem>
#include <set>

namespace petzval::render {

namespace {

class Collector {
 public:
  void add(const std::string& path) {
    std::error_code none;
    if (std::filesystem::is_regular_file(path, none) && seen_.insert(path).second) files.push_back(path);
  }
  /// Whatever text among the parameters is the name of a file. That a name which is none, "diffuse" perhaps,
  /// is also a file's does no harm.
  void add(const Entity& entity) {
    for (const Parameter& parameter : entity.parameters.list())
      for (const std::string& text : parameter.strings)
        if (!text.empty()) add(resolved_path(parameter.at, text));
  }

  std::vector<std::string> files;

 private:
  std::set<std::string> seen_;
};

}  // namespace

std::vector<std::string> scene_files(const SceneDescription& scene) {
  Collector all;
  for (const std::string& file : scene.files) all.add(file);
  for (const Entity* entity : {&scene.film, &scene.camera, &scene.sampler, &scene.integrator})
    all.add(*entity);
  for (const TextureDescription& texture : scene.textures) all.add(texture.entity);
  for (const Entity& material : scene.materials) all.add(material);
  for (const MediumDescription& medium : scene.media) all.add(medium.entity);
  for (const Entity& light : scene.area_lights) all.add(light);
  for (const LightDescription& light : scene.lights) all.add(light.entity);
  for (const ShapeDescription& shape : scene.shapes) all.add(shape.entity);
  for (const auto& object : scene.objects)
    for (const ShapeDescription& shape : object) all.add(shape.entity);
  return std::move(all.files);
}

std::string scene_files_fingerprint(const SceneDescription& scene) {
  std::string text;
  for (const std::string& file : scene_files(scene))
    text += fmt::format("file {} {}\n", file, hash_text(read_whole_file(file)));
  return text;
}

std::string hash_text(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char byte : text) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
  return fmt::format("{:016x}", hash);
}

}  // namespace petzval::render
