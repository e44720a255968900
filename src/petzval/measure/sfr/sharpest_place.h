// SPDX-License-Identifier: BSD-3-Clause
// Where a tilted chart is in focus.
#pragma once

#include <span>

namespace petzval {

/// The sharpness of one edge.
struct SharpnessAt {
  double place = 0;  ///< along the chart, in any unit
  double mtf50 = 0, deviation = 0;
};

struct SharpestPlace {
  double place = 0, deviation = 0;  ///< in the unit of the places
  double mtf50 = 0;                 ///< there
  std::size_t edges = 0;            ///< that count
};

/// 1/MTF50² = a + b (place − best)², as blur that grows with defocus adds to what is there without it, by
/// least squares; edges below half of the best sharpness, where blur is no Gaussian, count for nothing. The
/// deviation follows from the scatter about the fit, and is no less than that of the edges makes it. \throws
/// InputError for fewer than four edges, where sharpness does not fall to both sides, or is greatest beyond
/// the edges.
SharpestPlace sharpest_place(std::span<const SharpnessAt> edges);

}  // namespace petzval
