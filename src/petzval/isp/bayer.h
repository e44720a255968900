// SPDX-License-Identifier: BSD-3-Clause
// Methods for the Bayer mosaic; demosaiced() chooses among them.
#pragma once

#include <petzval/isp/demosaic.h>

namespace petzval {

/// High-quality linear interpolation by 5 × 5 filters (Malvar, He & Cutler, "High-quality linear
/// interpolation for demosaicing of Bayer-patterned color images", ICASSP 2004, figure 2).
Planes bayer_malvar(const LinearMosaic& mosaic);

/// Gradient-based threshold-free interpolation (Pekkucuksen & Altunbasak, "Gradient based threshold free
/// color filter array interpolation", ICIP 2010): colour differences are estimated along rows and along
/// columns; those of the four directions are weighted by the inverse square of their changes around the
/// pixel; red and blue follow from green and the differences.
Planes bayer_gradient(const LinearMosaic& mosaic);

/// The same in the root of the light, as pictures are displayed and as the noise of photons is even: colours
/// that differ in proportion, not in amount, keep their differences across an edge, and dark pixels beside
/// bright ones keep theirs. A toe of 1/64 of the mean magnitude keeps the root's slope finite at black, so
/// that a picture exposed k times as long comes out k times as bright. Where there is much noise,
/// interpolated values are too dark: by about σ²/4μ at a level μ.
Planes bayer_root_gradient(const LinearMosaic& mosaic);

/// Adaptive interpolation (Hamilton & Adams, US patent 5,629,734, 1997): green along the row or the column,
/// whichever the picture changes less along, with the curvature of the pixel's own colour; then red and blue
/// likewise along the diagonals, with the curvature of green.
Planes bayer_hamilton_adams(const LinearMosaic& mosaic);

}  // namespace petzval
