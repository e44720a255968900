// SPDX-License-Identifier: BSD-3-Clause
// What a sensor records.
#pragma once

#include <petzval/image/spectral_image.h>
#include <petzval/sensor/mosaic.h>

#include <cstdint>
#include <string>
#include <vector>

namespace petzval {

/// How the channels of a sensor see colours under one light, as DNG files state it.
struct ColourCalibration {
  int exif_light_source = 0;  ///< 17: A, 21: D65, 23: D50 (EXIF's LightSource)
  double temperature_k = 0;
  std::vector<double> camera_from_xyz = {};  ///< channels × 3: DNG's ColorMatrix
  std::vector<double>
      pcs_from_balanced;  ///< 3 × channels: DNG's ForwardMatrix, from white-balanced channels to XYZ of D50
};

struct PixelPlace {
  int row = 0, column = 0;
  bool operator==(const PixelPlace&) const = default;
};

/// A mosaic of numbers with all that is needed to make a picture of it.
struct RawImage {
  int columns = 0, rows = 0;
  Mosaic mosaic = {};
  std::vector<std::string> channels = {};   ///< names: "red", "green", "blue", …
  std::vector<std::uint16_t> samples = {};  ///< as stored, row by row

  /// The linear value of each stored one; empty: stored values are linear. Levels are those of linear values.
  std::vector<std::uint16_t> linearization = {};
  double black_level = 0, white_level = 65535;
  double dn_per_e = 0;      ///< linear values per electron; 0: not known
  double read_noise_e = 0;  ///< rms in the dark, quantisation included
  /// Variance of shot noise over that of a single exposure: 1/N of the mean of N.
  double shot_noise_share = 1;

  std::vector<ColourCalibration> calibrations = {};  ///< none, one or two
  std::vector<double> as_shot_neutral = {};  ///< of each channel under the light of the scene, the greatest 1

  std::vector<PixelPlace> bad_pixels = {};  ///< that the maker of the camera knows of, row by row

  double exposure_s = 0, iso = 0;
  double pitch_um = 0;  ///< 0: not known
  LensFacts lens = {};
  std::optional<DateTime> date_time = {};  ///< when the exposure began, if a user said so
  std::string sensor_name = {}, provenance = {};

  double pixel(int row, int column) const {
    const std::uint16_t stored = samples[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                                         static_cast<std::size_t>(column)];
    return linearization.empty() ? stored : linearization[stored];
  }
  /// Linear values have the variance slope · (value − black level) + offset.
  double noise_slope() const { return dn_per_e * shot_noise_share; }
  double noise_offset() const { return dn_per_e * dn_per_e * read_noise_e * read_noise_e; }
  /// \throws InputError if sizes, levels or matrices contradict each other.
  void validate() const;
};

/// What a picture made of it may note.
CameraFacts camera_facts(const RawImage& raw);

}  // namespace petzval
