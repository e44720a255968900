// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/render/gltf/gltf_scene.h>
#include <petzval/render/pbrt/scene_reader.h>

namespace petzval::render {

bool SceneReader::follow_block(const std::string& word, Tokens& tokens, const Location& at) {
  if (word == "AttributeBegin")
    save("AttributeEnd", at);
  else if (word == "TransformBegin")
    save("TransformEnd", at);
  else if (word == "AttributeEnd" || word == "TransformEnd")
    restore(word, at);
  else if (word == "ObjectBegin")
    begin_object(tokens, at);
  else if (word == "ObjectEnd") {
    if (open_object_ < 0) throw scene_error(at, "ObjectEnd without ObjectBegin");
    restore(word, at);
    open_object_ = -1;
  } else if (word == "ObjectInstance")
    place_object(tokens, at);
  else if (word == "Include" || word == "Import")
    include(tokens, at);
  else if (word == "WorldBegin") {
    if (in_world_) throw scene_error(at, "a second WorldBegin");
    in_world_ = true;
    state_.world_from_object = {};
    state_.start_active = state_.end_active = true;
    coordinate_systems_["world"] = {};
  } else
    return false;
  return true;
}

void SceneReader::restore(const std::string& word, const Location& at) {
  if (saved_.empty()) throw scene_error(at, fmt::format("{} without a beginning", word));
  if (word != saved_.back().ended_by)
    throw scene_error(at, fmt::format("{} where {} would be right, for the block begun at {}", word,
                                      saved_.back().ended_by, saved_.back().at.text()));
  if (word == "TransformEnd")
    state_.world_from_object = saved_.back().state.world_from_object;
  else
    state_ = std::move(saved_.back().state);
  saved_.pop_back();
}

void SceneReader::include(Tokens& tokens, const Location& at) {
  const std::string name = quoted(tokens, at, "file");
  if (has_gltf_name(name))
    return unsupported_.report(
        at, fmt::format("Include of the glTF scene {} (petzval render {} shows it by itself)", name, name));
  read_file(resolved_path(at, name), &at);
}

void SceneReader::begin_object(Tokens& tokens, const Location& at) {
  if (open_object_ >= 0)
    throw scene_error(at, fmt::format("ObjectBegin inside of the object begun at {}", object_at_.text()));
  const std::string name = quoted(tokens, at, "object's name");
  if (objects_.count(name)) throw scene_error(at, fmt::format("there is an object \"{}\" already", name));
  open_object_ = static_cast<int>(scene_.objects.size());
  objects_[name] = open_object_;
  object_at_ = at;
  scene_.objects.emplace_back();
  save("ObjectEnd", at);
}

void SceneReader::place_object(Tokens& tokens, const Location& at) {
  const std::string name = quoted(tokens, at, "object's name");
  const auto found = objects_.find(name);
  if (found == objects_.end())
    throw scene_error(at, fmt::format("there is no object \"{}\"; ObjectBegin makes one", name));
  if (open_object_ >= 0) throw scene_error(at, "ObjectInstance inside of an object");
  scene_.instances.push_back({found->second, world_from_object(at), at});
}

}  // namespace petzval::render
