// SPDX-License-Identifier: BSD-3-Clause
// Where the sensor would best stand. (MountedLens::move_sensor_mm puts it there.)
#pragma once

#include <petzval/analysis/field_tables.h>

#include <vector>

namespace petzval {

struct BestFocus {
  double shift_mm = 0;           ///< from the image surface of the lens, positive away from the lens
  double before = 0, after = 0;  ///< the measure at the image surface and at the best place
};

/// The sensor of smallest RMS spot radius, all wavelengths of a field together about their common centroid
/// and all fields alike; the measure is that radius [µm]. In closed form: over rays of weight w at r on the
/// image surface with slopes s = (α, β)/γ, shift = −Σ cov(r, s)/Σ var(s). Rays weigh as their area on the
/// stop. \param weights  one a wavelength, or none: all alike. \throws InputError naming a field at which no
/// ray passes, or weights that do not fit.
BestFocus best_spot_focus(const Lens& lens, const FieldTableRequest& request,
                          const std::vector<double>& weights = {});

/// The sensor of largest polychromatic diffraction MTF at one frequency, the mean over fields and both
/// directions; the measure is that mean. Searched about best_spot_focus by a scan over the depth in which the
/// MTF lives, then by parabolas, to 1e-4 of that depth. \throws InputError as best_spot_focus() and
/// mtf_table(), or for a frequency that is not positive.
BestFocus best_mtf_focus(const Lens& lens, const FieldTableRequest& request, double frequency_cpmm,
                         const std::vector<double>& weights = {});

}  // namespace petzval
