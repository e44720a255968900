// SPDX-License-Identifier: BSD-3-Clause
// A PSF whose MTF is what was measured.
#pragma once

#include <petzval/wave/psf.h>

#include <span>
#include <vector>

namespace petzval {

/// Contrast over frequency [cycles/mm], increasing, in the tangential direction (a pattern that changes along
/// t) and in the sagittal one.
struct MeasuredMtf {
  std::vector<double> frequency_cpmm, tangential, sagittal;
};

struct MtfPsf {
  Psf psf;
  double worst_misfit = 0;  ///< of the PSF's MTF at the measured frequencies
  double worst_frequency_cpmm = 0;
};

/// The PSF of the model OTF(f, φ) = T(f) cos²φ + S(f) sin²φ, φ from the tangential direction: real and
/// positive, T and S monotone cubics through the measurement from 1 at frequency 0, going on exponentially
/// beyond the last frequency. Its inverse transform is cut at zero, where it would be negative, and
/// normalised.
///
/// What an MTF does not hold, it cannot give: the PSF is symmetric, so coma becomes blur to both sides, and
/// contrast that came back reversed beyond a zero counts as upright.
/// \throws InputError for fewer than two frequencies, ones that do not increase, contrasts outside 0 … 1.02.
MtfPsf psf_of_mtf(const MeasuredMtf& mtf);

/// Modulus of the transform of a PSF, its samples squares of light, along t (tangential) or s.
double mtf_of_psf(const Psf& psf, double frequency_cpmm, bool tangential);

}  // namespace petzval
