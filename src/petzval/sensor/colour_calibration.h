// SPDX-License-Identifier: BSD-3-Clause
// What colours a sensor makes of its channels.
#pragma once

#include <petzval/colour/spectrum.h>
#include <petzval/sensor/raw_image.h>
#include <petzval/sensor/sensor.h>

#include <optional>
#include <vector>

namespace petzval {

inline constexpr double noisy_white_e = 1000;

/// The matrix that makes CIE XYZ of the channels under one light, fitted to a ColorChecker.
struct ColourFit {
  std::vector<double> neutral;  ///< response of the channels to a white surface, the greatest 1
  std::vector<double>
      xyz_from_camera;  ///< 3 × channels, for channels scaled as `neutral`; white has Y = 1, exactly
  std::vector<double> camera_from_xyz;                 ///< channels × 3; its inverse for three channels
  double mean_delta_e_2000 = 0, max_delta_e_2000 = 0;  ///< of the 24 patches, seen under that light
  /// Root mean square ΔE*ab over the patches that the noise of photons makes, noisy_white_e being white.
  double noise_delta_e_ab = 0;
};

/// Fits the linear map from channels to XYZ that keeps white white and makes the sum of ΔE*ab² over the 24
/// patches of the bundled ColorChecker smallest (Gauss-Newton with Levenberg's damping, from the least
/// squares in XYZ). \param white_e  electrons of white in the most sensitive channel: what their noise adds
/// to ΔE*ab² counts too, so that channels which tell colours apart by small differences of large numbers
/// count for less; absent: without noise. \throws InputError for a sensor of fewer than three channels.
ColourFit fit_colour(const Sensor& sensor, const Spectrum& light, std::optional<double> white_e = {});

/// The same for a DNG file, with the noise of a well exposed picture, white at 80 % of saturation: white
/// balance is divided out, the other side is XYZ of D50, adapted by Bradford.
ColourCalibration calibration(const Sensor& sensor, const Spectrum& light, int exif_light_source,
                              double temperature_k);

/// The two calibrations of DNG files: illuminant A and D65. Nothing for fewer than three channels.
std::vector<ColourCalibration> standard_calibrations(const Sensor& sensor);

/// Response of the channels to light of this spectrum, the greatest 1.
std::vector<double> neutral_of(const Sensor& sensor, const Spectrum& light);

}  // namespace petzval
