// SPDX-License-Identifier: BSD-3-Clause
// How a camera turns light into numbers, and how noisy these are: the methods of ISO 14524 and ISO 15739.
#pragma once

#include <petzval/measure/comparable_picture.h>
#include <petzval/sensor/raw_image.h>

#include <span>
#include <string>
#include <vector>

namespace petzval {

/// The noise of an even patch, in the numbers of the picture.
struct PatchNoise {
  double mean = 0;
  double temporal = 0;       ///< standard deviation from exposure to exposure
  double fixed_pattern = 0;  ///< standard deviation over the pixels, without what is temporal

  double total() const;
};

/// ISO 15739:2017, section 6.3. Of n exposures, x̄ their mean: σ²temporal = n/(n − 1) · ⟨var(x − x̄)⟩,
/// σ²fixed = var(x̄) − σ²temporal/n, variances over the pixels. \param exposures  the same pixels in the same
/// order, two times at least (the standard asks for eight). \throws InputError.
PatchNoise patch_noise(std::span<const std::vector<double>> exposures);

/// A grey patch of a chart in the picture, in pixels.
struct GreyPatch {
  int x = 0, y = 0, width = 0, height = 0;
  double exposure = 0;  ///< its luminance, or exposure in lux seconds, on a scale that all of them share
};

/// What a camera makes of one patch.
struct OecfPoint {
  GreyPatch patch;
  std::vector<double> levels;  ///< mean of each channel
  /// Of the channel; of pictures in colour, of luminance Y, whose variance is σ²(Y) + 0.279 σ²(R − Y) +
  /// 0.088 σ²(B − Y) (ISO 15739, ISO 12232).
  PatchNoise noise;
  bool clipped = false;         ///< pixels are white, or as good as
  double incremental_gain = 0;  ///< slope of the level over exposure; of clipped points 0

  /// Exposure over the noise of that kind as an exposure: noise / incremental gain. 0 if clipped.
  double total_snr() const { return snr(noise.total()); }
  double temporal_snr() const { return snr(noise.temporal); }
  double fixed_pattern_snr() const { return snr(noise.fixed_pattern); }

 private:
  double snr(double deviation) const;
};

/// The opto-electronic conversion function (ISO 14524) and what noise makes of it (ISO 15739).
struct Oecf {
  std::vector<std::string> channels;
  std::vector<OecfPoint> points;  ///< by exposure, the darkest first
  double white = 0;               ///< level
  /// The greatest exposure that is not clipped; where no patch is clipped (`saturates` false), that of the
  /// brightest.
  double saturation_exposure = 0;
  bool saturates = false;
  /// The exposure at which the temporal signal-to-noise ratio is 1: the darkest patch's noise over its
  /// incremental gain.
  double least_exposure = 0;

  /// ISO 15739: saturation over least exposure.
  double dynamic_range() const { return saturation_exposure / least_exposure; }
};

/// Of one channel of raw images: linear values [DN].
/// \throws InputError for patches that lie outside, or fewer than two exposures or unclipped patches.
Oecf measure_oecf(std::span<const RawImage> exposures, int channel, std::span<const GreyPatch> patches);
/// Of pictures for display: code values over full scale.
Oecf measure_oecf(std::span<const ComparablePicture> exposures, std::span<const GreyPatch> patches);

/// The six greys of a ColorChecker that is found in a picture, under a light; exposures are reflectances.
/// \throws InputError as find_chart().
std::vector<GreyPatch> colorchecker_greys(const std::string& picture, const Spectrum& light);

/// A table (.csv) with the columns x_px, y_px, width_px, height_px and exposure. \throws InputError.
std::vector<GreyPatch> read_grey_patches(const std::string& path);

}  // namespace petzval
