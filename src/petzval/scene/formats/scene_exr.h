// SPDX-License-Identifier: BSD-3-Clause
// Scenes in spectral OpenEXR files.
#pragma once

#include <petzval/scene/scene.h>
#include <petzval/scene/spectral_cube.h>

#include <string>

namespace petzval {

/// Reads radiance from S0 channels, in the unit that `emissiveUnits` says (radiance_scale), or reflectance
/// from T channels. Read from attributes, if they are there: sceneAngle_deg, sceneDistance_m, sceneName,
/// sceneIlluminant, sceneProjection, sceneYaw_deg, scenePitch_deg, sceneDepthFrom. A channel Z is depth [m].
/// \param check  is called before the numbers are read. \throws InputError for a damaged file.
SpectralCube read_scene_exr(const std::string& path, const CubeCheck& check = {});

/// Writes S0 channels with those attributes, and depth as Z. \throws InputError, Failure as
/// write_spectral_exr.
void write_scene_exr(const std::string& path, const Scene& scene);

}  // namespace petzval
