// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/render/pbrt/parameter_reader.h>
#include <petzval/render/pbrt/scene_reader.h>

namespace petzval::render {

bool SceneReader::follow_world(const std::string& word, Tokens& tokens, const Location& at) {
  if (word == "Shape")
    shape(tokens, at);
  else if (word == "Material") {
    scene_.materials.push_back(entity(tokens, at, "material", "material"));
    state_.material = static_cast<int>(scene_.materials.size()) - 1;
  } else if (word == "MakeNamedMaterial") {
    named_material(tokens, at);
  } else if (word == "NamedMaterial") {
    const std::string name = quoted(tokens, at, "material");
    const auto found = scene_.named_materials.find(name);
    if (found == scene_.named_materials.end())
      throw scene_error(at, fmt::format("there is no material \"{}\"; MakeNamedMaterial makes one", name));
    state_.material = found->second;
  } else if (word == "Texture")
    texture(tokens, at);
  else if (word == "LightSource")
    scene_.lights.push_back({entity(tokens, at, "light", "light"), world_from_object(at)});
  else if (word == "AreaLightSource") {
    scene_.area_lights.push_back(entity(tokens, at, "area light", "light"));
    state_.area_light = static_cast<int>(scene_.area_lights.size()) - 1;
  } else if (word == "ReverseOrientation")
    state_.reverse_orientation = !state_.reverse_orientation;
  else if (word == "Attribute")
    attribute(tokens, at);
  else if (word == "MakeNamedMedium") {
    quoted(tokens, at, "medium");
    read_parameters(tokens, at);
    unsupported_.report(at, "a participating medium");
  } else if (word == "MediumInterface") {
    std::string inside = quoted(tokens, at, "medium"), outside;
    if (tokens.peek() && tokens.peek()->kind == Token::Kind::quoted) outside = quoted(tokens, at, "medium");
    if (!inside.empty() || !outside.empty()) unsupported_.report(at, "a participating medium");
  } else
    return false;
  return true;
}

void SceneReader::texture(Tokens& tokens, const Location& at) {
  TextureDescription texture;
  texture.name = quoted(tokens, at, "texture's name");
  texture.value_type = quoted(tokens, at, "texture's type, float or spectrum,");
  if (texture.value_type == "color") texture.value_type = "spectrum";  // versions 1 to 3
  if (texture.value_type != "float" && texture.value_type != "spectrum")
    throw scene_error(at, fmt::format("a texture holds float or spectrum, not \"{}\"", texture.value_type));
  texture.entity = entity(tokens, at, "texture's class", "texture");
  texture.world_from_texture = world_from_object(at);
  scene_.textures.push_back(std::move(texture));
}

void SceneReader::named_material(Tokens& tokens, const Location& at) {
  const std::string name = quoted(tokens, at, "material's name");
  Entity material;
  material.parameters = read_parameters(tokens, at);
  material.type = material.parameters.string("type", "");
  if (material.type.empty())
    throw scene_error(at, fmt::format("material \"{}\" has no \"string type\"", name));
  scene_.materials.push_back(std::move(material));
  scene_.named_materials[name] = static_cast<int>(scene_.materials.size()) - 1;
}

void SceneReader::shape(Tokens& tokens, const Location& at) {
  if (!in_world_) throw scene_error(at, "a Shape before WorldBegin");
  ShapeDescription shape{entity(tokens, at, "shape", "shape"), world_from_object(at),
                         state_.reverse_orientation, state_.material, state_.area_light};
  if (open_object_ < 0) return scene_.shapes.push_back(std::move(shape));
  if (shape.area_light >= 0) {
    unsupported_.report(at, "a light in an object that is placed with ObjectInstance");
    shape.area_light = -1;
  }
  scene_.objects[static_cast<std::size_t>(open_object_)].push_back(std::move(shape));
}

void SceneReader::attribute(Tokens& tokens, const Location& at) {
  const std::string target = quoted(tokens, at, "target (shape, light, material, texture)");
  std::vector<Parameter>& defaults = state_.defaults[target];
  const Parameters given = read_parameters(tokens, at);
  for (Parameter parameter : given.list()) {
    parameter.used = true;  // what it does not apply to is no fault
    defaults.insert(defaults.begin(), std::move(parameter));
  }
}

}  // namespace petzval::render
