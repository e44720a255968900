// SPDX-License-Identifier: BSD-3-Clause
// The same scene under another light.
#pragma once

#include <petzval/scene/scene.h>

namespace petzval {

/// Puts a scene whose light is known under another: radiance × new/old illuminant, band by band. A perfect
/// white keeps its luminance (without visible bands: its radiance over all bands), whatever the scale of the
/// new light. Surfaces are taken to scatter light without changing its wavelength.
/// \throws InputError if the scene's light is not known, is zero where the scene has radiance, or if the new
/// one has no light in the bands.
void swap_illuminant(Scene& scene, const Spectrum& illuminant);

}  // namespace petzval
