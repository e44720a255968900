// SPDX-License-Identifier: BSD-3-Clause
// Colours of lines and maps in plots. These are for telling things apart, not colorimetry (that is `colour`).
#pragma once

#include <petzval/colour/colour_map.h>

#include <cstddef>

namespace petzval {

/// Of series, before they begin again.
constexpr std::size_t series_colour_count = 7;

/// Colour of the n-th series of a plot: six colours of Okabe & Ito (2008; yellow left out: it is lost on
/// white paper) and a grey, then again from the start. Whatever cones somebody lacks, any two of them differ
/// by 10 (CIEDE2000) or more.
Rgb8 series_colour(std::size_t index);

/// A colour that suggests a wavelength and is legible as a thin line on white and on black. Ultraviolet and
/// infrared take the colour of the end of the spectrum; a wavelength that is not a number is grey.
Rgb8 wavelength_colour(double wavelength_nm);

}  // namespace petzval
