// SPDX-License-Identifier: BSD-3-Clause
// The depth of a scene, to look at or to compute with.
#pragma once

#include <petzval/scene/scene.h>

#include <string>

#include "command.h"

namespace petzval::app {

/// What `scene info` says of it: "0.6 to 4 m from the sensor".
std::string depth_text(const Scene& scene);

/// Writes the depth map: .npy as it is [m]; .png in false colours, the nearest brightest, even in dioptres as
/// blur is. Where nothing is, is at infinity. \throws InputError for a scene without depth, or another
/// extension.
void write_depth(const std::string& path, const Scene& scene, const Shared& shared);

}  // namespace petzval::app
