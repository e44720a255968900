// SPDX-License-Identifier: BSD-3-Clause
// Lights from their descriptions.
#pragma once

#include <petzval/render/lights/lights.h>

namespace petzval::render {

struct LightOptions {
  /// pbrt-v4 scales every light so that a strength of 1 is a luminance (or luminous intensity) of 1 in the
  /// unit of ∫ L ȳ dλ. If set, spectra of lights given as tables, files or black bodies are radiances
  /// [W·m⁻²·sr⁻¹·nm⁻¹] as they stand.
  bool absolute_spectra = false;
  double scale = 1;  ///< of all lights
};

/// Adds the light of a LightSource to `lights`.
void add_light(const LightDescription& description, const WavelengthGroups& groups,
               const LightOptions& options, Unsupported& unsupported, Lights& lights);

/// The radiance of an AreaLightSource over a surface of this area [unit²].
BandSpectrum area_radiance(const Entity& entity, double area, const WavelengthGroups& groups,
                           const LightOptions& options, Unsupported& unsupported);

}  // namespace petzval::render
