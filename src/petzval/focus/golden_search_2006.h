// SPDX-License-Identifier: BSD-3-Clause
// The search of 2006, as a baseline.
#pragma once

#include <petzval/focus/autofocus.h>

#include <optional>

namespace petzval {

/// The search of the CS348B report of 2006, as a baseline: golden section in sub-intervals that grow with the
/// distance from the lens, each halted after several evaluations in a row below a share of the best so far.
struct GoldenSearchOptions {
  FocusMeasureOptions measure;
  double nearest_mm = 0, farthest_mm = 220;
  double tolerance_mm = 0.1;
  double first_interval_mm = 10, growth = 1.5;
  int weak_in_a_row = 3;
  double weak_share = 0.5;
  std::optional<int> most_evaluations = {};  ///< absent: as many as it takes; ≥ 2
};
FocusResult find_focus_2006(const PicturesAt& pictures_at, const std::vector<FocusZone>& zones,
                            const GoldenSearchOptions& options);

}  // namespace petzval
