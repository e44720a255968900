// SPDX-License-Identifier: BSD-3-Clause
// What fills the bodies of a glTF file: KHR_materials_volume.
#pragma once

#include <petzval/render/gltf/gltf_extensions.h>

namespace petzval::render {

/// Whether a material is that of a body, not of a sheet without thickness. How thick a body is, its mesh
/// says.
bool is_gltf_body(GltfExtension& volume);

/// The medium inside of a body, into SceneDescription::media; −1: none. Of light that goes as far as
/// `attenuationDistance` (in the world's unit) `attenuationColor` is left. \throws InputError.
int add_gltf_volume(const GltfFile& file, GltfExtension& volume, SceneDescription& scene);

}  // namespace petzval::render
