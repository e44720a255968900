// SPDX-License-Identifier: BSD-3-Clause
// Scenes of ISET and ISETCam: MATLAB files with a variable `scene`.
#pragma once

#include <petzval/scene/formats/mat_file.h>
#include <petzval/scene/scene.h>

#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// Reads an ISET scene from a MAT file of version 5, 7 or 7.3. Taken over are
///   data.photons    rows × columns × bands, photons/(s·m²·sr·nm): single or double as they are, uint8,
///   uint16 and
///                   uint32 rescaled linearly from 0 … 2^bitDepth − 1 to data.dmin … data.dmax
///   spectrum.wave   the bands' wavelengths [nm]
///   wAngular        horizontal angle [degrees];  distance [m];  depthMap [m];  name
///   illuminant      data.photons (or data.energy), if it is one spectrum for the whole scene
/// Photons become energy by h·c/λ at each band's wavelength. A file without `scene` that has mcCOEF and basis
/// is read by read_iset_basis. \param horizontal_angle_deg  for a file that has none. \throws InputError for
/// a damaged file, a missing or malformed field, NaN or negative radiance.
Scene read_iset_mat(const std::string& path, std::optional<double> horizontal_angle_deg = std::nullopt);

/// A struct `illuminant` of ISET: data.photons or data.energy, at its own spectrum.wave or at these bands.
/// Nothing unless it is one spectrum for all of the scene.
std::optional<Spectrum> iset_illuminant(const MatValue& illuminant, const std::vector<double>& bands_nm);

/// Energy of one photon [J]: h·c/λ with the constants of the SI.
double photon_energy_j(double wavelength_nm);

}  // namespace petzval
