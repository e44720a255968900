// SPDX-License-Identifier: BSD-3-Clause
// The lights of a scene that a camera can see.
#pragma once

#include <petzval/render/camera/lamp_guide.h>
#include <petzval/render/world.h>

#include <vector>

namespace petzval::render {

/// The surfaces that shine, each shape in a ball, in front of a camera.
std::vector<Lamp> lamps_of(const World& world, const Transform& world_from_camera);

}  // namespace petzval::render
