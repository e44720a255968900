// SPDX-License-Identifier: BSD-3-Clause
// The hierarchy of a glTF scene.
#pragma once

#include <petzval/render/gltf/gltf_file.h>
#include <petzval/render/transform.h>

#include <vector>

namespace petzval::render {

/// A node that the scene shows.
struct GltfNode {
  int index = 0;
  const tinygltf::Node* node = nullptr;
  std::string path;  ///< "nodes[3]"
  Transform world_from_node;
};

/// All nodes of the file's scene, parents first, in the order in which they are named. \throws InputError for
/// nodes that are not there or have two parents, and transformations that cannot be inverted.
std::vector<GltfNode> gltf_nodes(const GltfFile& file);

}  // namespace petzval::render
