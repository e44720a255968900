// SPDX-License-Identifier: BSD-3-Clause
// Scenes in spectral OpenEXR files.
#pragma once

#include <petzval/colour/spectrum.h>
#include <petzval/scene/scene.h>

#include <optional>
#include <string>

namespace petzval {

/// What a file may leave open.
struct SceneExrOptions {
  std::optional<double> horizontal_angle_deg;  ///< for a file without sceneAngle_deg
  std::optional<Spectrum> illuminant;  ///< the light that a reflectance picture is put under, on any scale
};

/// Reads radiance [W·m⁻²·sr⁻¹·nm⁻¹] from S0 channels (units as we write them, or "W.m^-2.sr^-1", by which
/// other programs mean the same, or none), or reflectance from T channels, which becomes radiance under the
/// illuminant, on its scale. Read from attributes, if they are there: sceneAngle_deg, sceneDistance_m,
/// sceneName, sceneIlluminant. \throws InputError for a damaged file, irradiance, an angle that is nowhere
/// given, a reflectance picture without an illuminant, negative or non-finite values.
Scene read_scene_exr(const std::string& path, const SceneExrOptions& options = {});

/// Writes S0 channels with those attributes; depth is left out. \throws InputError, Failure as
/// write_spectral_exr.
void write_scene_exr(const std::string& path, const Scene& scene);

}  // namespace petzval
