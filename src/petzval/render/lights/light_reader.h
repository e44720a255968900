// SPDX-License-Identifier: BSD-3-Clause
// Lights from their descriptions.
#pragma once

#include <petzval/render/lights/light_options.h>
#include <petzval/render/lights/lights.h>

namespace petzval::render {

/// Adds the light of a LightSource to `lights`.
void add_light(const LightDescription& description, const WavelengthGroups& groups,
               const LightOptions& options, Unsupported& unsupported, Lights& lights);

/// The radiance of an AreaLightSource over a surface of this area [unit²].
BandSpectrum area_radiance(const Entity& entity, double area, const WavelengthGroups& groups,
                           const LightOptions& options, Unsupported& unsupported);

/// The radiance "Le" of a medium; black without one.
BandSpectrum medium_radiance(const Parameters& parameters, const WavelengthGroups& groups,
                             const LightOptions& options, Unsupported& unsupported);

}  // namespace petzval::render
