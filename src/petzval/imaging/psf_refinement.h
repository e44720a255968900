// SPDX-License-Identifier: BSD-3-Clause
// Finer samples of a PSF whose samples say everything.
#pragma once

#include <petzval/wave/psf.h>

namespace petzval {

/// The same light on samples at most `widest_um` apart, as far as memory is bounded (half a million samples;
/// more only if the PSF has more).
///
/// A diffraction PSF is sampled at 0.45 λN: by the sampling theorem nothing is lost, but neither squares nor
/// straight lines between such samples are the PSF. So they are made finer by its Fourier transform, which is
/// then divided by that of a square as large as a fine sample: a pattern of such squares has the very
/// spectrum of the PSF. What is left for straight lines between fine samples to change is of the fourth order
/// in their spacing, once the moments of a kernel are matched (Kernel::match). A PSF whose spectrum does not
/// end within what its samples can say (more than 1 % left at its edge: light of cells, measured blur on
/// coarse samples) is returned as it is.
Psf refined_psf(const Psf& psf, double widest_um);

}  // namespace petzval
