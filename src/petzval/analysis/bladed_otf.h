// SPDX-License-Identifier: BSD-3-Clause
// The transfer function of a pupil that blades cut: its overlap with itself, without mirror symmetry.
#pragma once

#include <petzval/analysis/mtf.h>

#include <array>
#include <complex>
#include <functional>
#include <vector>

namespace petzval {

/// ∬ P(p) P*(p − s e) dp over ∬ |P|² dp, e along β (tangential) or α (sagittal).
/// \param outline  of the pupil, once round in (α, β), convex.
/// \param wave     (α, β) → complex amplitude inside the outline.
/// \param shift    s, in direction cosines: λ times the frequency.
/// \param nodes    along a chord; `whole_nodes`, where there is no shift. \param panels  of eight chords
/// each, across: several hundred chords for corners.
std::complex<double> bladed_otf(const std::vector<std::array<double, 2>>& outline,
                                const std::function<std::complex<double>(double, double)>& wave,
                                MtfDirection direction, double shift, int nodes, int panels,
                                int whole_nodes = 24);

}  // namespace petzval
