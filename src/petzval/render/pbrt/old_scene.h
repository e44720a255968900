// SPDX-License-Identifier: BSD-3-Clause
// Scenes of pbrt before version 4, as those of the CS348B course of 2006.
#pragma once

#include <petzval/render/pbrt/scene_description.h>

namespace petzval::render {

/// Puts what a scene of versions 1 to 3 says into the words of version 4, with a note: materials matte,
/// mirror, glass, plastic and the metals become the nearest of today, area lights diffuse ones; what only
/// steered the old program is dropped. What has no counterpart stays, and is reported where it is used.
void translate_old_scene(SceneDescription& scene);

}  // namespace petzval::render
