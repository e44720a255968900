// SPDX-License-Identifier: BSD-3-Clause
// Light into files, whichever way it came to the sensor: as irradiance, as a raw image, as a picture.
#pragma once

#include <petzval/base/staged_files.h>
#include <petzval/image/formats/plane_exr.h>
#include <petzval/image/picture.h>
#include <petzval/simulate/develop.h>
#include <petzval/simulate/expose.h>

#include <optional>
#include <string>
#include <vector>

namespace petzval {

/// What is done with light beyond keeping it.
struct OutputOptions {
  enum class Shows {
    automatic,  ///< what the sensor makes of the light, if it turns light into numbers
    developed,
    irradiance  ///< the light itself
  };
  Shows picture = Shows::automatic;  ///< what .png and .tif show
  int bits = 8;                      ///< of those: 8 or 16
  ExposeOptions expose = {};
  Development development = {};
  std::vector<std::pair<std::string, std::string>> step_files = {};  ///< of development: name, file
  /// How a picture of the light shows it: its white that of the scene where bands allow it, absent: as the
  /// light says. `expose` says how bright: a time or an exposure value as on a sensor of ISO 100, and more
  /// stops.
  PictureOptions shown = {};
  std::vector<ExrPlane> layers = {};  ///< further channels of an .exr of the light
};

/// What became of the light.
struct Outputs {
  std::optional<RawImage> raw;     ///< if there is a raw file or a developed picture
  std::optional<Picture> picture;  ///< if there is a developed picture
};

/// Whether a file holds the raw image of a sensor (.dng), or a picture (.png, .jpg, .tif).
bool is_raw_name(const std::string& path);
bool is_picture_name(const std::string& path);
/// Whether pictures are developed.
bool develops(const OutputOptions& options, const std::optional<Sensor>& sensor);

/// Tries on a few pixels what the files ask for, before the light is computed. \throws InputError for
/// extensions that hold none of the three, files that need a sensor which turns light into numbers, and
/// options that it cannot take.
void check_outputs(const std::vector<std::string>& paths, const std::optional<Sensor>& sensor,
                   const OutputOptions& options = {});

/// Writes all files, or none.
///
///     write_outputs(light, {"light.exr", "shot.dng", "shot.png"}, camera.sensor);
///
/// By their names: irradiance as .exr, .npy or .npz, the raw image as .dng, pictures as .png or .tif.
/// \throws InputError as check_outputs(); Failure; Cancelled.
Outputs write_outputs(SpectralImage light, const std::vector<std::string>& paths,
                      const std::optional<Sensor>& sensor, const OutputOptions& options = {},
                      const Context& context = {});
/// The same among other files, which the caller commits.
Outputs write_outputs(SpectralImage light, const std::vector<std::string>& paths,
                      const std::optional<Sensor>& sensor, const OutputOptions& options, StagedFiles& files,
                      const Context& context);

}  // namespace petzval
