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
    named_medium(tokens, at);
  } else if (word == "MediumInterface") {
    const std::string inside = quoted(tokens, at, "medium");
    const bool two = tokens.peek() && tokens.peek()->kind == Token::Kind::quoted;
    const std::string outside = two ? quoted(tokens, at, "medium") : inside;
    state_.media = {medium_called(inside, at), medium_called(outside, at)};
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

void SceneReader::named_medium(Tokens& tokens, const Location& at) {
  const std::string name = quoted(tokens, at, "medium's name");
  if (name.empty()) throw scene_error(at, "a medium without a name");
  const auto index = static_cast<std::size_t>(medium_called(name, at));
  NamedMedium& named = media_.at(name);
  if (named.made) throw scene_error(at, fmt::format("there is a medium \"{}\" already", name));
  named.made = true;
  MediumDescription& medium = scene_.media[index];
  medium.entity.parameters = parameters(tokens, at, "medium");
  medium.entity.type = medium.entity.parameters.string("type", "");
  medium.world_from_medium = world_from_object(at);
  if (medium.entity.type.empty())
    throw scene_error(at, fmt::format("medium \"{}\" has no \"string type\"", name));
}

int SceneReader::medium_called(const std::string& name, const Location& at) {
  if (name.empty()) return -1;
  const auto [found, is_new] = media_.insert({name, {static_cast<int>(scene_.media.size()), at, false}});
  if (is_new) scene_.media.push_back({name, {}, {}});
  return found->second.index;
}

void SceneReader::check_media() const {
  for (const auto& [name, named] : media_)
    if (!named.made)
      throw scene_error(named.at, fmt::format("there is no medium \"{}\"; MakeNamedMedium makes one", name));
}

void SceneReader::shape(Tokens& tokens, const Location& at) {
  if (!in_world_) throw scene_error(at, "a Shape before WorldBegin");
  ShapeDescription shape{entity(tokens, at, "shape", "shape"),
                         world_from_object(at),
                         state_.reverse_orientation,
                         state_.material,
                         state_.area_light,
                         {},
                         state_.media};
  if (open_object_ < 0) return scene_.shapes.push_back(std::move(shape));
  if (shape.area_light >= 0) {
    unsupported_.report(at, "a light in an object that is placed with ObjectInstance");
    shape.area_light = -1;
  }
  scene_.objects[static_cast<std::size_t>(open_object_)].push_back(std::move(shape));
}

void SceneReader::attribute(Tokens& tokens, const Location& at) {
  const std::string target = quoted(tokens, at, "target (shape, light, material, medium, texture)");
  std::vector<Parameter>& defaults = state_.defaults[target];
  const Parameters given = read_parameters(tokens, at);
  for (Parameter parameter : given.list()) {
    parameter.used = true;  // what it does not apply to is no fault
    defaults.insert(defaults.begin(), std::move(parameter));
  }
}

}  // namespace petzval::render
