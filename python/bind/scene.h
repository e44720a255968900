// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bind.h"

namespace petzval::python {

/// A SceneRequest, a name for one, or a Scene.
using SceneChoice = std::variant<SceneRequest, Scene>;
SceneChoice scene_from(const nb::object& scene);

}  // namespace petzval::python
