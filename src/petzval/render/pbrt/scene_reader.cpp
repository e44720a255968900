// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petzval/base/data_directory.h>
#include <petzval/base/whole_file.h>
#include <petzval/render/pbrt/old_scene.h>
#include <petzval/render/pbrt/scene_reader.h>

#include <algorithm>
#include <filesystem>
#include <map>

namespace petzval::render {

namespace {

constexpr std::size_t deepest_include = 64;

}  // namespace

void SceneReader::read_file(const std::string& path, const Location* included_from) {
  std::error_code none;
  const std::string canonical = std::filesystem::weakly_canonical(path, none).string();
  if (std::find(open_files_.begin(), open_files_.end(), canonical) != open_files_.end())
    throw scene_error(*included_from,
                      fmt::format("{} includes itself: {}", path, fmt::join(open_files_, " → ")));
  if (open_files_.size() >= deepest_include)
    throw scene_error(*included_from, fmt::format("files are included more than {} deep", deepest_include));
  std::string text;
  try {
    text = read_whole_file(path);
  } catch (const InputError& error) {
    if (included_from) throw scene_error(*included_from, error.what());
    throw;
  }
  open_files_.push_back(canonical);
  scene_.files.push_back(path);
  read_text(text, path);
  open_files_.pop_back();
}

void SceneReader::read_text(const std::string& text, const std::string& file) {
  Tokens tokens(text, std::make_shared<const std::string>(file));
  follow(tokens);
}

void SceneReader::follow(Tokens& tokens) {
  while (const std::optional<Token> token = tokens.next()) {
    const Location at = tokens.location(*token);
    if (token->kind != Token::Kind::word)
      throw scene_error(at, fmt::format("{} stands where a directive would be right", token->text));
    const std::string word(token->text);
    if (!follow_transform(word, tokens, at) && !follow_block(word, tokens, at) &&
        !follow_option(word, tokens, at) && !follow_world(word, tokens, at) && !follow_old(word, tokens, at))
      refuse_unknown(word, at);
  }
}

bool SceneReader::follow_old(const std::string& word, Tokens& tokens, const Location& at) {
  if (word == "WorldEnd") {  // the world of version 4 ends with the file
    is_old_ = true;
    return true;
  }
  if (word == "SurfaceIntegrator") {
    is_old_ = true;
    scene_.integrator = entity(tokens, at, "integrator");
    return true;
  }
  if (word == "VolumeIntegrator" || word == "Renderer") {  // of media, which have directives of their own
    is_old_ = true;
    entity(tokens, at, "integrator");
    return true;
  }
  static const std::map<std::string, const char*> now{{"Volume", "MakeNamedMedium"}};
  const auto old = now.find(word);
  if (old == now.end()) return false;
  unsupported_.report(at, fmt::format("{} of pbrt before version 4 (now {})", word, old->second));
  entity(tokens, at, "directive");
  return true;
}

void SceneReader::refuse_unknown(const std::string& word, const Location& at) {
  static const std::vector<std::string> known{
      // clang-format off
      "Identity", "Translate", "Scale", "Rotate", "LookAt",
      "Transform", "CoordinateSystem", "CoordSysTransform", "ConcatTransform", "AttributeBegin",
      "AttributeEnd", "ObjectBegin", "ObjectEnd", "ObjectInstance", "Include",
      "Import", "WorldBegin", "Camera", "Film", "Sampler",
      "Integrator", "PixelFilter", "Accelerator", "ColorSpace", "Option",
      "Shape", "Material", "MakeNamedMaterial", "NamedMaterial", "Texture",
      "LightSource", "AreaLightSource", "ReverseOrientation", "Attribute", "MakeNamedMedium", "ActiveTransform", "TransformTimes",
      "TransformBegin", "TransformEnd", "MediumInterface"
      // clang-format on
  };
  throw scene_error(at,
                    fmt::format("\"{}\" is no directive of pbrt-v4; the nearest are {}", word.substr(0, 80),
                                fmt::join(nearest_names(word.substr(0, 80), known), ", ")));
}

void SceneReader::finish() {
  if (!saved_.empty())
    throw scene_error(saved_.back().at, fmt::format("this block is not ended by {}", saved_.back().ended_by));
  if (!in_world_) throw InputError(scene_.file, "has no WorldBegin; what the scene holds stands after it");
  check_media();
  if (is_old_) translate_old_scene(scene_);
}

SceneDescription read_scene_description(const std::string& path, Unsupported& unsupported, double time) {
  SceneDescription scene;
  scene.file = path;
  scene.materials.push_back({"diffuse", {}});
  SceneReader reader(scene, unsupported, time);
  reader.read_file(path, nullptr);
  reader.finish();
  return scene;
}

SceneDescription parse_scene_description(const std::string& text, const std::string& file,
                                         Unsupported& unsupported, double time) {
  SceneDescription scene;
  scene.file = file;
  scene.materials.push_back({"diffuse", {}});
  SceneReader reader(scene, unsupported, time);
  reader.read_text(text, file);
  reader.finish();
  return scene;
}

}  // namespace petzval::render
