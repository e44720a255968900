// SPDX-License-Identifier: BSD-3-Clause
// Scenes that shine of their own warmth.
#pragma once

#include <petzval/scene/scene.h>

#include <optional>
#include <span>
#include <vector>

namespace petzval {

/// What surrounds a warm scene and what its surfaces are.
struct ThermalOptions {
  std::optional<double> temperature_k = {};  ///< of all surfaces, where the file has none
  double emissivity = 1;                     ///< of all surfaces and bands, where the file has none; 0 to 1
  std::optional<double> background_k = {};   ///< of what the surfaces mirror; absent: nothing (0 K)

  /// \throws InputError saying what would be right.
  void validate() const;
};

/// Radiance of a grey surface [W·m⁻²·sr⁻¹·nm⁻¹]: ε B(λ, T) + (1 − ε) B(λ, background), Planck's law and
/// Kirchhoff's.
double thermal_radiance(double wavelength_nm, double temperature_k, double emissivity,
                        std::optional<double> background_k);

/// Turns the emissivities that the bands of a scene hold into radiance at options.temperature_k.
/// \throws InputError for an emissivity outside 0 to 1, or no temperature.
void warm_emissivities(Scene& scene, const ThermalOptions& options);

/// Fills all bands with the radiance of surfaces of options.emissivity at these temperatures [K], row by row;
/// notes it where all are colder than any scene.
/// \throws InputError for a temperature that is not positive and finite.
void warm_temperatures(Scene& scene, std::span<const float> temperatures_k, const ThermalOptions& options);

}  // namespace petzval
