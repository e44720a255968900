// SPDX-License-Identifier: BSD-3-Clause
// Steps of development that are off unless asked for.
#pragma once

#include <petzval/isp/demosaic.h>

namespace petzval {

/// Unsharp masking: adds `amount` times the difference from a Gaussian blur of standard deviation `sigma_px`.
/// \throws InputError for a sigma that is not above 0 or exceeds 50 pixels.
void sharpen(Planes& planes, double amount, double sigma_px);

enum class ToneCurve {
  none,  ///< linear up to white, where it is cut
  soft   ///< linear up to half of white, then a shoulder up to what brightening made of white
};

/// The stops that bring to white what 99 % of the pixels do not exceed in the greatest of their planes, after
/// noise has been averaged over 4 × 4 of them; as `sense` meters highlights. 0 for a black picture; at
/// most 16.
double automatic_exposure_ev(const Planes& rgb);

/// Multiplies by 2^exposure_ev, then applies the curve to the greatest of the three planes and scales the
/// others with it, so that hues stay. Values below 0 become 0.
void apply_tone(Planes& rgb, double exposure_ev, ToneCurve curve);

}  // namespace petzval
