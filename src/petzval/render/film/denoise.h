// SPDX-License-Identifier: BSD-3-Clause
// A picture of few samples, made smooth where nothing in it says otherwise.
#pragma once

#include <array>
#include <vector>

namespace petzval::render {

/// A picture as two independent halves of its samples.
struct PictureHalves {
  /// Of first surfaces: albedo of three ranges of bands, normal (3 axes), and the reciprocal of the depth;
  /// means over all rays.
  static constexpr int feature_count = 7;
  struct Half {
    std::vector<float> light;     ///< [pixel][band], in any unit
    std::vector<float> features;  ///< [feature][pixel], each on any scale
  };

  int columns = 0, rows = 0, bands = 0;
  std::array<Half, 2> halves;
};

/// The mean of both halves without most of its noise, [pixel][band].
///
/// Each pixel becomes the value at itself of a plane through its neighbours' light: linear in the features,
/// by weighted least squares. The weights of a half come from the other half: how alike the surroundings of
/// two pixels are, measured by the noise (non-local means; Rousselle, Knaus and Zwicker, "Adaptive rendering
/// with non-local means filtering", 2012). The noise is known by the difference of the halves. Features are
/// freed of theirs first (Rousselle, Manzi and Zwicker 2013), each by itself; the fit is that of Bitterli and
/// others, "Nonlinearly weighted first-order regression", 2016. A narrow filter, a wide one and none at all
/// are tried, and each pixel takes what is estimated to be nearest to the truth: the mean squared difference
/// of a half that is filtered from the other half, which is not, has the error and a constant as its
/// expectation. All bands of a pixel share one set of weights. \throws InputError if a size does not fit;
/// Cancelled.
std::vector<float> denoised(const PictureHalves& picture);

}  // namespace petzval::render
