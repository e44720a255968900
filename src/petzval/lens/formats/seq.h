// SPDX-License-Identifier: BSD-3-Clause
// CODE V command files (.seq) that enter a lens.
#pragma once

#include <petzval/lens/lens_file.h>

#include <string>

namespace petzval {

/// Surfaces are given by curvature unless RDM says radius; the thickness of the image surface is a shift of
/// focus and is added to the last gap.
/// \param text  decoded. \param file  for error messages.
/// \throws InputError naming line and surface for everything that changes rays and is not modelled.
LensFile read_seq(const std::string& text, const std::string& file, const LensReadOptions& options);

/// By curvature, so that every double survives. \throws InputError for what such a file cannot hold: odd
/// powers of r and those above 20, an aperture given at the stop, model glasses off the normal line.
std::string seq_text(const Lens& lens);

/// The letters of the coefficients of r^4, r^6 … r^20.
inline constexpr std::string_view seq_asphere_letters = "ABCDEFGHJ";
inline constexpr int seq_lowest_asphere_power = 4;

}  // namespace petzval
