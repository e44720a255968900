// SPDX-License-Identifier: BSD-3-Clause
// The shape of a focus measure against film distance.
#pragma once

#include <petzval/focus/autofocus.h>

#include <limits>
#include <optional>

namespace petzval {

/// log measure = height − power · log((x − peak)² + width²), fitted to evaluations: geometry blurs by a disc
/// whose width grows with |x − peak|, so that far off the measure falls as a power of the distance, and near
/// by it is a parabola.
struct DefocusCurve {
  double peak = 0, width = 0, height = 0, power = 0, residual = std::numeric_limits<double>::infinity();
};

/// The best curve whose peak lies in (low, high) and is no narrower than that, by search on ever finer grids;
/// the best evaluations count most. Nothing where none fits.
std::optional<DefocusCurve> fit_curve(const FocusResult& result, double low, double high, double least_width);

/// Where the polynomial peaks that fits the logarithm of the measure best within `reach` of a place: a cubic,
/// for lopsided peaks, or of fewer than five places a parabola. Nothing without three places there or a
/// maximum among them.
std::optional<double> local_peak(const FocusResult& result, double about, double reach);

}  // namespace petzval
