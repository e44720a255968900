// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/render/pbrt/scene_reader.h>

namespace petzval::render {

bool SceneReader::follow_transform(const std::string& word, Tokens& tokens, const Location& at) {
  if (word == "Identity") {
    set(at, [&] { return Transform(); });
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
  } else if (word == "ActiveTransform") {
    active_transform(tokens, at);
  } else if (word == "TransformTimes") {
    const auto v = numbers(tokens, at, 2);
    if (in_world_) throw scene_error(at, "TransformTimes after WorldBegin; before it would be right");
    if (!(v[0] < v[1])) throw scene_error(at, "TransformTimes that do not increase");
    start_time_ = v[0], end_time_ = v[1];
  } else {
    return false;
  }
  return true;
}

void SceneReader::transform(const Location& at, const std::function<Transform()>& make) {
  try {
    const Transform made = make();
    MovingTransform& current = state_.world_from_object;
    if (state_.start_active) current.start = current.start * made;
    if (state_.end_active) current.end = current.end * made;
  } catch (const InputError& error) {
    throw scene_error(at, error.what());
  }
}

void SceneReader::set(const Location& at, const std::function<Transform()>& make) {
  try {
    const Transform made = make();
    if (state_.start_active) state_.world_from_object.start = made;
    if (state_.end_active) state_.world_from_object.end = made;
  } catch (const InputError& error) {
    throw scene_error(at, error.what());
  }
}

void SceneReader::active_transform(Tokens& tokens, const Location& at) {
  const std::optional<Token> which = tokens.next();
  const std::string word(which ? which->text : "");
  if (word != "StartTime" && word != "EndTime" && word != "All")
    throw scene_error(at, fmt::format("ActiveTransform {}; StartTime, EndTime or All would be right", word));
  state_.start_active = word != "EndTime";
  state_.end_active = word != "StartTime";
}

Transform SceneReader::world_from_object(const Location& at) {
  const MovingTransform& now = state_.world_from_object;
  if (now.start.matrix() == now.end.matrix()) return now.start;
  scene_.moves = true;
  try {
    return Transform::between(now.start, now.end, (time_ - start_time_) / (end_time_ - start_time_));
  } catch (const InputError& error) {
    throw scene_error(at, error.what());
  }
}

}  // namespace petzval::render
