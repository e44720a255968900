// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/render/pbrt/scene_reader.h>

namespace petzval::render {

bool SceneReader::follow_transform(const std::string& word, Tokens& tokens, const Location& at) {
  if (word == "Identity") {
    state_.world_from_object = Transform();
  } else if (word == "Translate") {
    const auto v = numbers(tokens, at, 3);
    transform(at, [&] { return Transform::translation({v[0], v[1], v[2]}); });
  } else if (word == "Scale") {
    const auto v = numbers(tokens, at, 3);
    transform(at, [&] { return Transform::scaling({v[0], v[1], v[2]}); });
  } else if (word == "Rotate") {
    const auto v = numbers(tokens, at, 4);
    transform(at, [&] { return Transform::rotation(v[0], {v[1], v[2], v[3]}); });
  } else if (word == "LookAt") {
    const auto v = numbers(tokens, at, 9);
    transform(at, [&] {
      return Transform::look_at({v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]});
    });
  } else if (word == "Transform" || word == "ConcatTransform") {
    const auto v = numbers(tokens, at, 16);
    Matrix4 m;
    for (std::size_t i = 0; i < 16; ++i) m[i % 4][i / 4] = v[i];  // columns first in the file
    if (word == "Transform")
      set(at, [&] { return Transform(m); });
    else
      transform(at, [&] { return Transform(m); });
  } else if (word == "CoordinateSystem") {
    coordinate_systems_[quoted(tokens, at, "name")] = state_.world_from_object;
  } else if (word == "CoordSysTransform") {
    const std::string name = quoted(tokens, at, "name");
    const auto found = coordinate_systems_.find(name);
    if (found == coordinate_systems_.end())
      throw scene_error(
          at, fmt::format("there is no coordinate system \"{}\"; CoordinateSystem names one", name));
    state_.world_from_object = found->second;
  } else {
    return false;
  }
  return true;
}

void SceneReader::transform(const Location& at, const std::function<Transform()>& make) {
  set(at, [&] { return state_.world_from_object * make(); });
}

void SceneReader::set(const Location& at, const std::function<Transform()>& make) {
  try {
    state_.world_from_object = make();
  } catch (const InputError& error) {
    throw scene_error(at, error.what());
  }
}

}  // namespace petzval::render
