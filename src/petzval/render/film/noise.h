// SPDX-License-Identifier: BSD-3-Clause
// How far a rendering still is from its converged picture.
#pragma once

#include <petzval/render/film/pixel_window.h>

#include <span>
#include <vector>

namespace petzval::render {

/// The noise of a picture from the error of each pixel: in tiles of 16 × 16 pixels, the root of the mean
/// squared error over the mean light (over a tenth of the whole picture's mean where a tile is darker than
/// that); and of all tiles the value that nine in ten keep. So a caustic in a corner does not hold up a
/// picture that is done everywhere else. \param squared_errors  of each pixel, or unbiased estimates of them.
/// \param light  of each pixel, in the same unit.
double noise_of(const PixelWindow& window, std::span<const double> squared_errors,
                std::span<const double> light);

/// noise_of() a picture made of two independent halves of as many samples: a quarter of the squared
/// difference of their means has the squared error of the mean of both as its expectation, however the
/// samples of each half are stratified. \param whole  sums of light over the samples of both.
/// \param half  over those of one. \param samples  of each pixel in both.
double estimated_noise(const PixelWindow& window, std::span<const double> whole, std::span<const double> half,
                       int samples);

}  // namespace petzval::render
