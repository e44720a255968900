// SPDX-License-Identifier: BSD-3-Clause
// What noise tells of a sensor: gain, full well, read noise, non-uniformities, by the methods of EMVA 1288.
#pragma once

#include <petzval/measure/oecf.h>
#include <petzval/sensor/capture.h>
#include <petzval/sensor/raw_image.h>

#include <optional>
#include <span>
#include <vector>

namespace petzval {

/// Two exposures of the same uniform light: what one channel says. A DN is a step of the stored numbers, at
/// black where the camera's converter is not linear; numbers are proportional to light, by the linearization.
struct TransferPoint {
  double exposure_s = 0;
  double mean_dn = 0;  ///< black level included
  double temporal_variance_dn2 =
      0;  ///< half of that of the difference of the two, in which fixed patterns cancel
};

/// \throws InputError unless both are of one size, with pixels of the channel.
TransferPoint transfer_point(const RawImage& first, const RawImage& second, int channel);

/// The photon-transfer curve and what follows from it (EMVA Standard 1288, release 4.0, of linear cameras).
struct PhotonTransfer {
  std::vector<TransferPoint> points;  ///< the first is dark
  double dn_per_e = 0;      ///< system gain K: slope of variance over mean, up to 70 % of saturation
  double dark_noise_e = 0;  ///< temporal, without quantisation; an upper bound if quantisation_limited
  /// The dark variance is below 0.24 DN²: steps hide the noise, of which no more is known than that it stays
  /// below 0.4 DN (EMVA 1288, section 6.6).
  bool quantisation_limited = false;
  double saturation_e = 0;  ///< where the variance is greatest: the first pixels of the brightest are full
  std::optional<double> full_signal_e = {};  ///< where all pixels are; absent if no point is so bright
  double dynamic_range_db = 0;  ///< 20 log₁₀ of saturation over the signal whose signal-to-noise ratio is 1
  double snr_max_db = 0;        ///< 20 log₁₀ √saturation
};

/// \param points  the dark one first, then at least two with light. \throws InputError for points that give
/// no gain.
PhotonTransfer photon_transfer(std::vector<TransferPoint> points);

/// Spatial non-uniformity from stacks of exposures.
struct NonUniformity {
  double dsnu_e = 0;  ///< rms of the dark signal over pixels; an upper bound if dsnu_quantisation_limited
  bool dsnu_quantisation_limited = false;  ///< as PhotonTransfer's; noise and pattern together are hidden
  double prnu_percent = 0;                 ///< rms of the response over pixels
};

/// EMVA 1288: variances over the pixels of the means of the stacks, less what temporal noise leaves in them.
/// \param dark, half  stacks of at least two exposures without light and near half of saturation. \throws
/// InputError as transfer_point.
NonUniformity non_uniformity(std::span<const RawImage> dark, std::span<const RawImage> half, int channel,
                             double dn_per_e);

/// Signal-to-noise ratios of ISO 15739 where an 18 % grey lies if 141 % of white saturate (12.7 % of
/// saturation, as in ISO 12232), and its dynamic range.
struct GreyNoise {
  double signal_e = 0, total_snr = 0, temporal_snr = 0, fixed_pattern_snr = 0;
  double dynamic_range_db = 0;  ///< 20 log₁₀ of saturation over the temporal noise in the dark
};

/// From stacks of exposures: without light, and of the grey. \throws InputError as patch_noise().
GreyNoise grey_noise(std::span<const RawImage> dark, std::span<const RawImage> grey, int channel,
                     const PhotonTransfer& transfer);

/// A sensor under test: uniform light on a square of `side` pixels in its middle.
struct SensorTest {
  PhotonTransfer transfer;
  NonUniformity uniformity;
  GreyNoise grey;
};

/// Exposes the sensor as EMVA 1288 wants it and evaluates one channel; every pixel gets the current of that
/// channel. \param levels  of light from near darkness to beyond saturation, and as many again about the
/// level at which the variance turns; \param stack  exposures for the non-uniformities.
SensorTest test_sensor(const Sensor& sensor, const CaptureOptions& options, int channel, int side = 256,
                       int levels = 24, int stack = 32);

}  // namespace petzval
