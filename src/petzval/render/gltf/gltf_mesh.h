// SPDX-License-Identifier: BSD-3-Clause
// Triangles of a glTF file.
#pragma once

#include <petzval/render/gltf/gltf_file.h>
#include <petzval/render/shapes/triangle_mesh.h>

namespace petzval::render {

/// The triangles of a primitive (list, strip or fan) in the space of its node, v of the texture coordinates
/// turned upwards. Nothing for points and lines, which have no surface: `notes` tell of them. \param path
/// "meshes[0].primitives[1]". \param uv_set  which TEXCOORD is wanted. \throws InputError.
std::shared_ptr<const TriangleMesh> read_gltf_triangles(const GltfFile& file,
                                                        const tinygltf::Primitive& primitive,
                                                        const std::string& path, int uv_set,
                                                        Unsupported& unsupported,
                                                        std::vector<std::string>& notes);

}  // namespace petzval::render
