// SPDX-License-Identifier: BSD-3-Clause
// Which points of a sweep are good, and how many of all that come off a line would be.
#pragma once

#include <petzval/tolerance/yield.h>

#include "sweep_result.h"

namespace petzval::app {

/// "corners.least_cpp>=0.2"
struct Criterion {
  std::string column;
  bool at_least = true;
  double value = 0;

  std::string text() const;
};

/// \throws InputError saying what would be right.
Criterion parse_criterion(const std::string& text);

/// Measures the corners of a point's picture, "corners" among its numbers; null for what cannot be measured.
void measure_corners(PointResult& result, const Shared& shared);

/// The columns of those.
std::vector<std::string> corner_columns();

/// A point by a sweep's criteria.
struct JudgedPoint {
  bool good = false;
  double value = 0;  ///< of the first criterion's column, its worst row; NaN where it was not measured
};

/// Good is a point at which every row has every column, within its limit; a failed one is not.
std::vector<JudgedPoint> judged_points(const std::vector<PointResult>& results,
                                       const std::vector<Criterion>& criteria);

std::size_t good_points(const std::vector<JudgedPoint>& points);

/// "yield: 20 of 24, 83.3 % (95 % interval 62.6 to 95.3 %), with corners.least_cpp >= 0.2"
std::string yield_text(const std::vector<JudgedPoint>& points, const std::vector<Criterion>& criteria);

}  // namespace petzval::app
