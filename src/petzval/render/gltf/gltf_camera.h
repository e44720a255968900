// SPDX-License-Identifier: BSD-3-Clause
// The camera of a glTF scene.
#pragma once

#include <petzval/render/gltf/gltf_nodes.h>
#include <petzval/render/pbrt/scene_description.h>

#include <array>

namespace petzval::render {

/// The first perspective camera that the scene shows, as a pinhole with a film of 480 rows of its shape; or,
/// if there is none, one that sees all of the scene from +z, and a note that says so. A camera's znear and
/// zfar, which depth buffers need, are left aside. \param box  that holds the scene. \throws InputError.
void add_gltf_camera(const GltfFile& file, const std::vector<GltfNode>& nodes,
                     const std::array<Vector3, 2>& box, Unsupported& unsupported, SceneDescription& scene);

}  // namespace petzval::render
