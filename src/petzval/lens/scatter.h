// SPDX-License-Identifier: BSD-3-Clause
// How the surfaces of a lens scatter light: polish, a measured curve, dust.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace petzval {

/// What one surface scatters. Lengths β of direction cosines along the surface count as in air: n sin θ, so
/// that an irregularity of a period p sends light to |β − β₀| = λ/p on either side.
///
/// The polish is one of three: an RMS `roughness_nm` (J. C. Stover, Optical Scattering, 3rd ed. 2012, ch. 3),
/// `b0_per_sr`, both with the shape b (1 + (|β − β₀|/l)²)^(s/2) (J. E. Harvey 1976), or a `table`. They hold
/// at `wavelength_nm`; at another wavelength the same irregularities send the light elsewhere: angles grow
/// with λ, the share that is scattered falls with λ². Dust is discs on the surface.
struct Scatter {
  std::optional<double> roughness_nm = {};  ///< RMS, of the irregularities that are longer than λ
  std::optional<double> b0_per_sr = {};     ///< the BSDF at the specular direction
  double l = 0.01;                          ///< where it turns from flat to falling
  double s = -1.5;                          ///< and how it falls from there on
  double wavelength_nm = 632.8;             ///< at which b0, l and the table hold
  /// (angle from the specular direction at normal incidence in air [degrees], BSDF [1/sr]), increasing
  /// angles; powers of the angle's sine in between, held before the first and nothing beyond the last.
  std::vector<std::pair<double, double>> table = {};
  double dust_percent = 0;  ///< of the surface, that dust covers
  /// Dust by IEST-STD-CC1246D: one particle per 0.1 m² is larger than so many micrometres.
  std::optional<double> cleanliness_level = {};

  bool operator==(const Scatter&) const = default;
  bool has_polish() const { return roughness_nm || b0_per_sr || !table.empty(); }
  /// What dust covers, as a share. Of the particles of a level, log₁₀ N = 0.926 (log₁₀² level − log₁₀² d) per
  /// 0.1 m² are larger than d µm (E. N. Borson 2005); they are discs from 1 µm up to the level.
  double dust_share() const;
  /// The level whose dust covers that; 1: no dust.
  double dust_level() const;
  /// \throws InputError saying which entry is wrong and what would be right.
  void validate() const;
};

/// The entries as they are read from and written to text, in their order; `table` is a CSV file there.
///
///     const Scatter scatter = parse_scatter("roughness=1.5,l=0.01,s=-1.8,dust=0.02");
///
/// Keys: roughness [nm], b0 [1/sr], l, s, wavelength [nm], table [a CSV file of angle_deg,bsdf_per_sr], dust
/// [%], level. \throws InputError for anything else.
Scatter parse_scatter(const std::string& text);

/// Reads angles [degrees] and BSDFs [1/sr] from CSV text with the header "angle_deg,bsdf_per_sr".
/// \param file  for messages. \throws InputError with file and line.
std::vector<std::pair<double, double>> parse_scatter_table(const std::string& text, const std::string& file);

}  // namespace petzval
