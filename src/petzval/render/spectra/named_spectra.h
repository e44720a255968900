// SPDX-License-Identifier: BSD-3-Clause
// Spectra as scene files give them: by name, file, colour, temperature or table.
#pragma once

#include <petzval/render/pbrt/scene_description.h>

#include <functional>
#include <optional>
#include <string>

namespace petzval::render {

/// A value at every wavelength [nm].
using SpectralFunction = std::function<double(double wavelength_nm)>;

/// A function of wavelength from a scene, and what is known of it.
struct SceneSpectrum {
  SpectralFunction at;
  bool constant = false;
  /// ∫ ȳ dλ of the light's shape [nm × unit]; pbrt-v4 divides every light by it, so that "L" of 1 means a
  /// luminance of 1 in the unit of ∫ L ȳ dλ, 683 cd/m². For rgb, that of the illuminant D65 alone.
  double photometric = 0;
};

/// What an rgb triple stands for (pbrt-v4): a reflectance in [0, 1], a quantity without bound, or light of
/// the illuminant D65 times a colour.
enum class SpectrumRole { albedo, unbounded, illuminant };

/// The parameter `name` as a spectrum: rgb, blackbody, spectrum (a name, a file, or pairs of nm and value) or
/// float. Nothing if there is no such parameter, or it names a texture. Named are pbrt's metals
/// (metal-Ag-eta, metal-Ag-k, Al, Au, Cu), glasses (glass-BK7, glass-BAF10, glass-FK51A, glass-LASF9,
/// glass-SF5, glass-SF10, glass-SF11, or any "CATALOGUE:NAME" of Petzval's glasses), diamond, and illuminants
/// (stdillum-A, -D50, -D65, -F11). \throws InputError with file, line and column; through `unsupported` for a
/// name that is not known.
std::optional<SceneSpectrum> spectrum_parameter(const Parameters& parameters, const std::string& name,
                                                SpectrumRole role, Unsupported& unsupported);

/// A constant.
SceneSpectrum constant_spectrum(double value);
/// The illuminant D65, the white of sRGB.
SceneSpectrum white_light();

}  // namespace petzval::render
