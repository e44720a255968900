// SPDX-License-Identifier: BSD-3-Clause
// Where something stands in a scene file, and the errors that say so.
#pragma once

#include <petzval/base/error.h>

#include <memory>
#include <string>

namespace petzval::render {

/// A place in a scene file; line and column count from 1.
struct Location {
  std::shared_ptr<const std::string> file;
  int line = 0, column = 0;

  /// "scene.pbrt:12:7"
  std::string text() const;
};

/// The input error "<file>:<line>:<column>: message".
InputError scene_error(const Location& at, const std::string& message);

}  // namespace petzval::render
