// SPDX-License-Identifier: BSD-3-Clause
// Single lights of a scene, altered before its world is built.
#pragma once

#include <petzval/render/lights/light_change.h>
#include <petzval/render/pbrt/scene_description.h>

#include <span>

namespace petzval::render {

/// Whether a medium sends out light of its own, strong or not.
bool shines(const MediumDescription& medium);

/// The lights of a scene by the numbers that LightChange has: "0 infinite", "1 area diffuse", "2 medium
/// fire".
std::vector<std::string> lights_of(const SceneDescription& scene);

/// \throws InputError for a light that the scene has not, naming those that it has, and for a surface or a
/// medium to be turned.
void alter_lights(std::span<const LightChange> changes, SceneDescription& scene);

/// The parameter that alter_lights() leaves with a light for its colour.
inline constexpr const char* colour_of_light = "petzval colour";
/// The same with a medium, for how much stronger it shines.
inline constexpr const char* strength_of_medium = "petzval strength";

}  // namespace petzval::render
