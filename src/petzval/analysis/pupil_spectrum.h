// SPDX-License-Identifier: BSD-3-Clause
// The pupils of a field at many wavelengths, most of them interpolated.
#pragma once

#include <petzval/analysis/pupil_fit.h>

#include <optional>
#include <span>
#include <vector>

namespace petzval {

/// A field at one wavelength.
struct PupilAt {
  const FieldTracer* tracer = nullptr;
  const ChiefRay* chief = nullptr;
};

/// fit_pupil() at every wavelength of a field, in any order. Where there are a dozen of them or more, a few
/// are fitted, and outlines and polynomials are interpolated over the wavenumber (Lagrange's polynomial
/// through members next to Chebyshev's points; Trefethen, Approximation Theory and Approximation Practice,
/// chapters 2 and 15). Two fits between them show whether the outline follows: if not, the list is halved.
/// Real rays at every other wavelength show whether phase and amplitude follow to 5e-5 waves and 5e-4 of
/// the largest amplitude, or five times what the fits leave: if not, that wavelength is fitted, too. So
/// narrow absorption, odd tables of indices and apertures that take over at one end of the spectrum cost
/// time and no accuracy.
/// \param fitted  if not null, is told of each entry whether it was fitted itself.
/// \returns one for each entry; nothing where fit_pupil() returns nothing.
std::vector<std::optional<SmoothPupil>> fit_pupils(std::span<const PupilAt> at,
                                                   const PupilFitLimits& limits = {},
                                                   std::vector<bool>* fitted = nullptr);

}  // namespace petzval
