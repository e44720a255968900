// SPDX-License-Identifier: BSD-3-Clause
// The overlap of a pupil that blades cut with itself, without mirror symmetry.
#pragma once

#include <petzval/analysis/pupil_overlap.h>

#include <array>
#include <complex>
#include <vector>

namespace petzval {

/// ∬ P(p) P*(p − s e) dp, e along β (tangential) or α (sagittal).
/// \param outline  of the pupil, once round in (α, β), convex.
/// \param shift    s, in direction cosines: λ times the frequency.
/// \param rule     along a chord, on [0, 1]. \param panels  of eight chords each, across: several hundred
/// chords for corners.
std::complex<double> bladed_overlap(const std::vector<std::array<double, 2>>& outline,
                                    const OverlapAlong& along, MtfDirection direction, double shift,
                                    const QuadratureRule& rule, int panels);

}  // namespace petzval
