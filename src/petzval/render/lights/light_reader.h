// SPDX-License-Identifier: BSD-3-Clause
// Lights from their descriptions.
#pragma once

#include <petzval/render/lights/lights.h>

namespace petzval::render {

/// Adds the light of a LightSource to `lights`. \param absolute  see WorldOptions.
void add_light(const LightDescription& description, const WavelengthGroups& groups, bool absolute,
               Unsupported& unsupported, Lights& lights);

/// The radiance of an AreaLightSource over a surface of this area [unit²].
BandSpectrum area_radiance(const Entity& entity, double area, const WavelengthGroups& groups, bool absolute,
                           Unsupported& unsupported);

}  // namespace petzval::render
