// SPDX-License-Identifier: BSD-3-Clause
// What first surfaces are, without the noise of few samples.
#pragma once

#include <petzval/render/film/denoise.h>

namespace petzval::render {

/// Coefficients of a plane in the features.
inline constexpr int feature_terms = PictureHalves::feature_count + 1;

/// The features of both halves without their noise, as through a lens that is out of focus: each is smoothed
/// by itself, the weights of one half from the other (non-local means), in units of the standard deviation
/// that it has over the picture. \returns [pixel][term]; term 0 is 1 in all. \throws Cancelled.
std::vector<float> smooth_features(const PictureHalves& picture);

}  // namespace petzval::render
