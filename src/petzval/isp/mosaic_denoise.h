// SPDX-License-Identifier: BSD-3-Clause
// Denoising of raw pictures.
#pragma once

#include <petzval/isp/linear_mosaic.h>

namespace petzval {

/// Takes noise out of a mosaic before anything mixes its pixels, where the noise of each is its own and its
/// size is known: variance noise_scale · x + noise_offset of a linear value x.
///
/// Values are brought to unit variance (Anscombe's transform for Poisson and Gaussian noise; back by the
/// closed form of the exact unbiased inverse, Mäkitalo & Foi, "Optimal inversion of the generalized Anscombe
/// transformation for Poisson-Gaussian noise", IEEE TIP 2013). Pixels of one place in the mosaic's period
/// make a plane; the planes become sums and differences: of all, of channels, of pixels of one channel, which
/// have no level of their own (the mean of four ways to divide the picture into periods). Each is denoised by
/// cosine transforms of overlapping
/// squares of 8 × 8: small coefficients are cut, and the result tells the gains of a second pass (Yu &
/// Sapiro, "DCT image denoising", IPOL 2011, with the Wiener step of BM3D, Dabov et al. 2007); what is
/// coarser comes from the picture at half, a quarter … of the size (Facciolo & Pierazzo, "Multi-scale DCT
/// denoising", IPOL 2017).
///
/// The same bytes for any number of threads. \param strength  1: for the noise as it is; 0: nothing is done.
/// \throws InputError for a negative
/// strength, and for a mosaic whose period has more than 64 pixels.
void denoise_mosaic(LinearMosaic& mosaic, double strength, double noise_scale, double noise_offset);

}  // namespace petzval
