// SPDX-License-Identifier: BSD-3-Clause
// Where something stands in a scene file, and the errors that say so.
#pragma once

#include <petzval/base/error.h>

#include <memory>
#include <string>

namespace petzval::render {

/// A place in a scene file: line and column, from 1, or the path of an entry of a JSON file.
struct Location {
  std::shared_ptr<const std::string> file;
  int line = 0, column = 0;
  std::shared_ptr<const std::string> path{};  ///< "materials[2].normalTexture"; null in text files

  /// "scene.pbrt:12:7" or "scene.gltf: materials[2].normalTexture"
  std::string text() const;
};

/// The input error "<text of the place>: message".
InputError scene_error(const Location& at, const std::string& message);

}  // namespace petzval::render
