// SPDX-License-Identifier: BSD-3-Clause
// Irradiance pictures in files, the format chosen by the extension.
#pragma once

#include <petzval/image/formats/plane_exr.h>
#include <petzval/image/spectral_image.h>

#include <string>
#include <vector>

namespace petzval {

/// Writes an image as spectral OpenEXR (.exr), NumPy array (.npy) or archive of arrays (.npz).
///
/// .exr carries everything: channels S0.…nm, emissiveUnits "W.m^-2.nm^-1", and the attributes pixelPitch_um
/// (double), pixelAperture ("box" or "point") and comments (the provenance); and `layers`, whatever they are,
/// as further channels, which read_irradiance() leaves aside. .npy is float32 of shape (rows,
/// columns, bands) and carries neither wavelengths nor pitch nor units. .npz has the same array as
/// `irradiance`, and `wavelengths_nm` and `pitch_um`, but neither lens nor light. \throws InputError for
/// another extension, and as the writers; Failure.
void write_irradiance(const std::string& path, const SpectralImage& image,
                      const std::vector<ExrPlane>& layers = {});
/// The same for an image whose values nobody needs any more: as write_npy().
void write_irradiance(const std::string& path, SpectralImage&& image,
                      const std::vector<ExrPlane>& layers = {});

/// What a file of bare numbers does not say.
struct BareIrradiance {
  std::vector<double> wavelengths_nm = {};  ///< of .npy
  double pitch_um = 0;                      ///< of .npy, and of .npz without one
  PixelAperture aperture = PixelAperture::box;
  std::string photosite = {};
};

/// Reads what write_irradiance wrote as .exr.
/// \throws InputError for a file that is damaged or holds something else (radiance, no pitch, NaN), and for
/// .npy.
SpectralImage read_irradiance(const std::string& path);

/// The same, and .npy and .npz, [W·m⁻²·nm⁻¹] of shape (rows, columns, bands) or (rows, columns) of one band.
/// \throws InputError also for wavelengths that are missing, too many or too few.
SpectralImage read_irradiance(const std::string& path, const BareIrradiance& bare);

}  // namespace petzval
