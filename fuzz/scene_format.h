// SPDX-License-Identifier: BSD-3-Clause
// Entries of three-dimensional scenes and their meshes.
#pragma once

#include <string_view>

namespace petzval::fuzz {

/// A scene is refused in one line, or has a camera and makes a world through which light can be followed.
bool try_scene(std::string_view bytes);

/// The same of a glTF scene, text or binary; it names no files.
bool try_gltf(std::string_view bytes);

/// A PLY mesh is refused in one line, or its triangles are corners that there are.
bool try_ply(std::string_view bytes);
bool try_nanovdb(std::string_view bytes);
bool try_measured_brdf(std::string_view bytes);

}  // namespace petzval::fuzz
