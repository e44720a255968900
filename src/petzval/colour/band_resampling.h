// SPDX-License-Identifier: BSD-3-Clause
// Spectra at other wavelengths, with no light made or lost.
#pragma once

#include <petzval/colour/spectrum.h>

#include <cstddef>
#include <span>
#include <vector>

namespace petzval {

/// From samples at some wavelengths, linear in between, to samples at others.
///
/// The curve over the new range is taken at the old and the new wavelengths together; each of these samples,
/// times the width that it stands for (band_widths_nm), is shared between the two new bands about it as a
/// straight line shares it. So
///   - the integral by the trapezoid rule over the new bands is that of the curve over their range, exactly;
///   - nothing becomes negative;
///   - bands that are kept, with none left out between them, stay as they are, and bands put in between old
///     ones lie on the line between them;
///   - where bands are left out, those that stay are means of what lay about them.
/// A single new band has no width: it is the value of the curve.
class BandResampling {
 public:
  /// Both strictly increasing. \throws InputError unless the new wavelengths lie within the old ones.
  BandResampling(std::span<const double> from_nm, std::span<const double> to_nm);

  /// A new band is the sum of old ones times these.
  struct Term {
    std::size_t band;
    double weight;
  };
  std::span<const Term> terms(std::size_t new_band) const { return rows_[new_band]; }
  std::size_t bands() const { return rows_.size(); }

 private:
  std::vector<std::vector<Term>> rows_;
};

/// A spectrum so resampled.
Spectrum resampled(const Spectrum& spectrum, std::span<const double> to_nm);

}  // namespace petzval
