// SPDX-License-Identifier: BSD-3-Clause
// Which files a scene is made of, and whether they are still the same.
#pragma once

#include <petzval/render/pbrt/scene_description.h>

#include <string>
#include <vector>

namespace petzval::render {

/// The scene's own file with all that it includes, and every file that a parameter names: meshes, pictures,
/// spectra, lenses. Each once, in the order in which they are named.
std::vector<std::string> scene_files(const SceneDescription& scene);

/// One line "file <path> <hash of its bytes>" for each of scene_files(). \throws InputError for a file that
/// can no longer be read.
std::string scene_files_fingerprint(const SceneDescription& scene);

/// 64 bits of a text in hexadecimal: the hash FNV-1a (Fowler, Noll & Vo 1991).
std::string hash_text(std::string_view text);

}  // namespace petzval::render
