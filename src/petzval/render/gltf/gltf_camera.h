// SPDX-License-Identifier: BSD-3-Clause
// The camera of a glTF scene.
#pragma once

#include <petzval/render/gltf/gltf_nodes.h>
#include <petzval/render/pbrt/scene_description.h>

namespace petzval::render {

/// The first perspective camera that the scene shows, as a pinhole with a film of 480 rows of its shape; or,
/// if there is none, one that looks along −z and still has to stand back. A camera's znear and zfar, which
/// depth buffers need, are left aside. \throws InputError.
void add_gltf_camera(const GltfFile& file, const std::vector<GltfNode>& nodes, Unsupported& unsupported,
                     SceneDescription& scene);

}  // namespace petzval::render
