// SPDX-License-Identifier: BSD-3-Clause
// KHR_lights_punctual.
#pragma once

#include <petzval/render/gltf/gltf_nodes.h>
#include <petzval/render/pbrt/scene_description.h>

namespace petzval::render {

/// Adds the light of a node, if it has one: point and spot in candela, directional in lux. A light's range,
/// which no real light has, is left aside. \throws InputError.
void add_gltf_light(const GltfFile& file, const GltfNode& node, Unsupported& unsupported,
                    SceneDescription& scene);

}  // namespace petzval::render
