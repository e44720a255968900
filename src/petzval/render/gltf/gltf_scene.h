// SPDX-License-Identifier: BSD-3-Clause
// Scenes in glTF 2.0, told in the terms of pbrt-v4.
#pragma once

#include <petzval/render/pbrt/scene_description.h>

#include <string>
#include <string_view>

namespace petzval::render {

/// Whether a file's name ends as that of a glTF scene does: .gltf or .glb.
bool has_gltf_name(const std::string& path);

/// Reads a scene of glTF 2.0 (Khronos Group 2021), .gltf or .glb, with the buffers and pictures that it
/// names: triangles, the hierarchy of nodes, metallic-roughness materials, emission, KHR_lights_punctual and
/// perspective cameras. Luminances (nit), intensities (candela) and illuminances (lux) are taken as glTF
/// states them. \throws InputError with the path of the entry that is wrong, "scene.gltf:
/// meshes[0].primitives[1].indices: …"; for names of files outside of the scene's folder and for other
/// schemes than data:; and through `unsupported`.
SceneDescription read_gltf_scene(const std::string& path, Unsupported& unsupported);
/// The same from bytes. \param path  for messages, and the folder that names of files start from.
SceneDescription parse_gltf_scene(const std::string& bytes, const std::string& path,
                                  Unsupported& unsupported);

}  // namespace petzval::render
