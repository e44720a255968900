// SPDX-License-Identifier: BSD-3-Clause
// In which units the lights of a scene are.
#pragma once

namespace petzval::render {

struct LightOptions {
  /// pbrt-v4 scales every light so that a strength of 1 is a luminance (or luminous intensity) of 1 in the
  /// unit of ∫ L ȳ dλ. If set, spectra of lights given as tables, files or black bodies are radiances
  /// [W·m⁻²·sr⁻¹·nm⁻¹] as they stand.
  bool absolute_spectra = false;
  double scale = 1;  ///< of all lights
};

}  // namespace petzval::render
