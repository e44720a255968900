// SPDX-License-Identifier: BSD-3-Clause
// Colours of lines and maps in plots. These are for telling things apart, not colorimetry (that is `colour`).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace petzval {

/// 8-bit sRGB.
struct Rgb8 {
  std::uint8_t r = 0, g = 0, b = 0;
  /// "#rrggbb"
  std::string hex() const;
  friend bool operator==(const Rgb8&, const Rgb8&) = default;
};

/// Colour of the n-th series of a plot: seven colours that people with any colour vision tell apart (Okabe &
/// Ito 2008, yellow left out: it is lost on white paper), then again from the start.
Rgb8 series_colour(std::size_t index);

/// A colour that suggests a wavelength and is legible as a thin line on white and on black. Ultraviolet and
/// infrared take the colour of the end of the spectrum; a wavelength that is not a number is grey.
Rgb8 wavelength_colour(double wavelength_nm);

enum class ColourMap { grey, viridis, inferno };

/// 256 colours from dark to light; all three grow steadily in lightness, so they survive a grey printer.
std::array<Rgb8, 256> colour_table(ColourMap map);

}  // namespace petzval
