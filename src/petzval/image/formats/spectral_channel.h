// SPDX-License-Identifier: BSD-3-Clause
// Channel names of spectral OpenEXR files: "S0.550,0nm", "T.0,55um".
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace petzval {

/// What a channel of a spectral OpenEXR file holds (Fichet, Pacanowski & Wilkie, "An OpenEXR Layout for
/// Spectral Images", JCGT 10 (3), 2021, section 3).
struct SpectralChannel {
  enum class Kind { emissive, reflective };  ///< S…: light; T: reflectance or transmittance
  Kind kind = Kind::emissive;
  int stokes = 0;  ///< 0 (intensity) to 3 (polarisation); 0 for reflective channels
  double wavelength_nm = 0;
};

/// The name that the layout gives a channel: shortest decimals that read back exactly, a comma as decimal
/// mark.
std::string spectral_channel_name(SpectralChannel channel);

/// Reads a channel name: a wavelength in m or a frequency in Hz with any SI prefix (nm, um, THz), comma or
/// point as decimal mark, optional exponent. Nothing for other names ("R", "depth.Z").
std::optional<SpectralChannel> parse_spectral_channel(std::string_view name);

}  // namespace petzval
