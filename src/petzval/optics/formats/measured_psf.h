// SPDX-License-Identifier: BSD-3-Clause
// A PSF from measured samples.
#pragma once

#include <petzval/wave/psf.h>

#include <string>
#include <vector>

namespace petzval {

struct MeasuredSample {
  double x_mm = 0, y_mm = 0, value = 0;
};

/// x is s and y is t of the Psf. The samples must fill a grid of equal steps. Where (0, 0) lies between
/// samples, each goes to its neighbours by nearness: light and its centre stay. \throws InputError (without a
/// file) for a grid with holes, too few samples, no light, negative values unless `clip_negative`.
Psf psf_of_samples(const std::vector<MeasuredSample>& samples, bool clip_negative);

}  // namespace petzval
