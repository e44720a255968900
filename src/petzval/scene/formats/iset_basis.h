// SPDX-License-Identifier: BSD-3-Clause
// Multispectral images of ISET in their compressed form: coefficients of basis functions.
#pragma once

#include <petzval/scene/formats/mat_file.h>
#include <petzval/scene/scene.h>

#include <optional>

namespace petzval {

/// Whether a file has the variables that read_iset_basis wants.
bool has_iset_basis(const MatFile& file);

/// Makes a scene of these variables of a MAT file:
///   mcCOEF          rows × columns × functions, numbers of any type
///   basis           struct: `basis`, wavelengths × functions; `wave` [nm]
///   imgMean         a number a wavelength, added to every pixel; may be missing
///   illuminant      struct: spectrum.wave with data.photons or data.energy, or `wavelength` (or `wave`) with
///                   `data` in energy units; may be missing
///   fov             horizontal angle [degrees]; dist [m]; name; may be missing
/// Photons/(s·m²·sr·nm) = Σ mcCOEF · basis + imgMean, below 0 taken for 0 as ISET does (the sum of a few
/// functions undershoots); they become energy by h·c/λ.
/// \param horizontal_angle_deg  for a file that has none. \throws InputError for sizes that do not agree.
Scene read_iset_basis(const MatFile& file, std::optional<double> horizontal_angle_deg);

}  // namespace petzval
