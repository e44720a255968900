// SPDX-License-Identifier: BSD-3-Clause
// Standard deviations of measured edges, from what each knows and what others of the same blur show.
#pragma once

#include <petzval/measure/sfr/measure_edge.h>

#include <span>

namespace petzval {

/// Fills in `sfr_deviation` and the deviations of levels, from `parts`. What corners add to an edge often
/// hides in its noise; the mean square over edges that rise over about the same distance shows it. All have
/// the same frequencies.
void state_deviations(std::span<EdgeMeasurement* const> edges);

}  // namespace petzval
