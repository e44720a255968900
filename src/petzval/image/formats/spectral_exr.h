// SPDX-License-Identifier: BSD-3-Clause
// Spectral OpenEXR files.
#pragma once

#include <petzval/base/large_floats.h>
#include <petzval/image/formats/plane_exr.h>
#include <petzval/image/formats/spectral_channel.h>

#include <cstddef>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace petzval {

/// Units that Petzval writes in the attribute `emissiveUnits`.
inline constexpr const char* spectral_radiance_units = "W.m^-2.sr^-1.nm^-1";
inline constexpr const char* spectral_irradiance_units = "W.m^-2.nm^-1";
/// Where OpenEXR keeps depth.
inline constexpr const char* exr_depth_channel = "Z";
/// Where Petzval keeps which pixels show a lamp itself: 1 or 0.
inline constexpr const char* exr_lamps_channel = "lamps";

/// A spectral image as a file holds it: a scene's radiance, a sensor's irradiance, a texture's reflectance.
///
///     SpectralExr exr;
///     exr.width = 640, exr.height = 480;
///     exr.wavelengths_nm = {450, 550, 650};
///     exr.units = spectral_radiance_units;
///     exr.values = LargeFloats(exr.band_size() * exr.wavelengths_nm.size());
///     write_spectral_exr("scene.exr", exr);
struct SpectralExr {
  using Kind = SpectralChannel::Kind;

  int width = 0, height = 0;
  Kind kind = Kind::emissive;
  bool also_reflective = false;  ///< of a file that is read: reflectances beside the light were left aside
  std::vector<double> wavelengths_nm;  ///< strictly increasing
  std::string units;         ///< attribute emissiveUnits; empty if the file has none (reflectance has none)
  LargeFloats values;        ///< a plane a wavelength, rows from the top
  std::vector<float> depth;  ///< of the channel Z [as the file has it], a plane; empty: none
  std::vector<float> lamps;  ///< of the channel "lamps", likewise
  std::vector<ExrPlane> others;                ///< further channels that are written; none is read
  std::map<std::string, std::string> strings;  ///< other attributes of the file that are text
  std::map<std::string, double> numbers;       ///< other attributes that are one number

  std::size_t band_size() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  std::span<float> plane(std::size_t band) { return values.all().subspan(band * band_size(), band_size()); }
  std::span<const float> plane(std::size_t band) const {
    return values.all().subspan(band * band_size(), band_size());
  }
  /// \throws InputError at the first value that is NaN or infinite, naming wavelength, row and column.
  /// \param file  for the message.
  void validate(const std::string& file) const;
};

/// Reads the layout of Fichet, Pacanowski & Wilkie 2021: half, float or integer channels, scan lines or
/// tiles, any compression, any data window. If the file has light (S0) and reflectance (T), the light is
/// read; polarisation (S1…S3), colour previews (R, G, B) and bi-spectral channels are left aside. Bands are
/// sorted. \throws InputError if the file is missing, damaged, truncated or not spectral, or has a band
/// twice. Values are not looked at: see SpectralExr::validate. \param check  is called before values and
/// depth are read, and may throw.
SpectralExr read_spectral_exr(const std::string& path,
                              const std::function<void(const SpectralExr&)>& check = {});

/// Where the values of a file go: a plane a band, rows from the top.
struct SpectralPlanes {
  std::vector<std::span<float>> bands;
  /// Called when rows [first, end) are there.
  std::function<void(int first, int end)> after_rows = {};
};
/// The same with the values put elsewhere, without a copy: `values` stays empty. \param place  is called
/// before values are read, and may throw.
SpectralExr read_spectral_exr_into(const std::string& path,
                                   const std::function<SpectralPlanes(const SpectralExr&)>& place);

/// Writes 32-bit floats, scan lines, ZIP compression; the same bytes for the same image.
/// \throws InputError unless the sizes agree and the wavelengths increase, and as WholeFile; Failure.
void write_spectral_exr(const std::string& path, const SpectralExr& exr);
/// The same with the values taken from elsewhere, without a copy; `description.values` is not looked at.
/// \param after_rows  called now and then between rows, as values are read.
void write_spectral_exr(const std::string& path, const SpectralExr& description,
                        std::span<const float> values, const std::function<void()>& after_rows = {});

}  // namespace petzval
