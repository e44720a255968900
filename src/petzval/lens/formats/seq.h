// SPDX-License-Identifier: BSD-3-Clause
// CODE V command files (.seq) that enter a lens.
#pragma once

#include <petzval/lens/lens_file.h>

#include <array>
#include <string>
#include <string_view>

namespace petzval {

/// Surfaces are given by curvature unless RDM says radius; the thickness of the image surface is a shift of
/// focus and is added to the last gap.
/// \param text  decoded. \param file  for error messages.
/// \throws InputError naming line and surface for everything that changes rays and is not modelled.
LensFile read_seq(const std::string& text, const std::string& file, const LensReadOptions& options);

/// By curvature, so that every double survives; aspheres as ASP, or as SPS ODD where ASP does not hold them.
/// \throws InputError for what such a file cannot hold: powers of r above 30, an aperture given at the stop,
/// model glasses off the normal line.
std::string seq_text(const Lens& lens);

/// The letters of the coefficients of r^4, r^6 … r^20.
inline constexpr std::string_view seq_asphere_letters = "ABCDEFGHJ";
inline constexpr int seq_lowest_asphere_power = 4;
/// The odd polynomial SPS ODD: SCO C1 is the conic K, C(p + 1) or ARp the coefficient of r^p, C33 the radius
/// NRADIUS that r is divided by, 0 for none.
inline constexpr int seq_highest_odd_power = 30, seq_odd_radius_term = 33;

/// Where a surface stands in the axes of the one before, and the tilts.
inline constexpr std::array<std::string_view, 6> seq_decentres{"XDE", "YDE", "ZDE", "ADE", "BDE", "CDE"};

}  // namespace petzval
