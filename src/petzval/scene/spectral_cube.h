// SPDX-License-Identifier: BSD-3-Clause
// Numbers of a file by row, column and wavelength, and what makes a scene of them.
#pragma once

#include <petzval/scene/scene.h>
#include <petzval/scene/thermal.h>

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace petzval {

/// What the numbers of a spectral file are.
enum class SceneQuantity {
  radiance,
  reflectance,  ///< 0 to 1: needs an illuminant
  emissivity,   ///< 0 to 1: needs a temperature
  temperature   ///< a map [K], of one band: needs wavelengths
};
/// "radiance", "reflectance", "emissivity" or "temperature". \throws InputError for another word.
SceneQuantity parse_scene_quantity(const std::string& word);

/// A file's numbers and whatever it says about them.
struct SpectralCube {
  int columns = 0, rows = 0, bands = 0;
  std::vector<double> wavelengths_nm;  ///< strictly increasing; empty: not said
  LargeFloats values;                  ///< a plane a band, rows from the top
  double scale = 1;                    ///< times every number
  std::optional<SceneQuantity> quantity;
  std::string radiance_unit;  ///< as radiance_scale() takes it; empty: W·m⁻²·sr⁻¹·nm⁻¹
  std::optional<double> horizontal_angle_deg, distance_m;
  std::optional<Spectrum> illuminant;
  std::string name;
  std::vector<float> depth_m;  ///< as Scene has it
  DepthFrom depth_from = DepthFrom::sensor;
  std::optional<PanoramaView> panorama;  ///< the samples are an equirectangular panorama
  std::vector<std::string> notes;        ///< as Scene has them

  std::size_t band_size() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
  std::span<float> plane(std::size_t index) { return values.all().subspan(index * band_size(), band_size()); }
};

/// What readers of files call when all but the values is there, before they are read. May throw.
using CubeCheck = std::function<void(const SpectralCube&)>;

/// What the user says about a file that leaves things open.
struct CubeOptions {
  std::optional<SceneQuantity> quantity;
  std::string radiance_unit;           ///< empty: the file's
  double scale = 1;                    ///< times every number and the file's scale, before anything else
  std::vector<double> file_bands_nm;   ///< of a file that does not say its wavelengths
  std::vector<double> wavelengths_nm;  ///< wanted; of temperatures the only ones there are
  std::optional<double> horizontal_angle_deg;
  std::optional<Spectrum> illuminant;  ///< for reflectances, on any scale; swapped for that of a radiance
  ThermalOptions thermal;
  bool negative_is_zero = false;  ///< instead of an error
  bool level_follows = false;     ///< somebody gives the scene a mean luminance: reflectances need none
};

/// Refuses what scene_of() would refuse whatever the values are: they need not be there yet.
void check_cube(const SpectralCube& cube, const CubeOptions& options);

/// Radiance is taken as it is; reflectance × illuminant is brought to a mean luminance of 100 cd/m² if it is
/// visible, unless the level follows. Reflectances of more than 2 are per cent or counts, and refused; of
/// more than 1.2, noted. Emissivities and temperatures shine by Planck's law. A temperature map has the
/// wavelengths that are wanted, all others those of the file. \throws InputError for anything that is missing
/// or does not fit, saying which option would help.
Scene scene_of(SpectralCube cube, const CubeOptions& options);

}  // namespace petzval
