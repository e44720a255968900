// SPDX-License-Identifier: BSD-3-Clause
// How far one picture is from another.
#pragma once

#include <petzval/measure/comparable_picture.h>

#include <vector>

namespace petzval {

/// Differences of a picture from a reference, over some set of values v of the picture and r of the
/// reference.
struct PictureDifference {
  double relative_l2 = 0;          ///< √Σ(v − r)² / √Σr²
  double max_error_over_peak = 0;  ///< max|v − r| / peak
  double psnr_db = 0;              ///< 20 log₁₀(peak/RMS(v − r)); infinite for equal pictures
  double peak = 0;                 ///< max|r| over all bands; of pictures for display, full scale
};

struct PictureComparison {
  PictureDifference all;                 ///< over all bands
  std::vector<PictureDifference> bands;  ///< each by itself, with the peak of all
};

/// Compares after checking that sizes, bands, units and pixel pitch are the same, as far as both files say. A
/// reference that is zero everywhere gives differences of 0 where the picture is too, infinite ones where it
/// is not. \throws InputError saying what differs.
PictureComparison compare_pictures(const ComparablePicture& picture, const ComparablePicture& reference);

}  // namespace petzval
