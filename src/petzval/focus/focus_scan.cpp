// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/focus/defocus_curve.h>
#include <petzval/focus/focus_judge.h>
#include <petzval/focus/focus_scan.h>

#include <algorithm>
#include <cmath>

namespace petzval {

FocusResult scan_focus(const PicturesAt& pictures_at, const std::vector<FocusZone>& zones,
                       const FocusMeasureOptions& measure, double nearest_mm, double farthest_mm, int count) {
  check_film_range(nearest_mm, farthest_mm);
  if (count < 3) throw InputError("a scan for focus takes at least 3 places");
  FocusJudge judge(pictures_at, zones, measure);
  const double step = (farthest_mm - nearest_mm) / (count - 1);
  for (int i = 0; i < count; ++i) judge.at(nearest_mm + step * i, "scan");
  require_contrast(judge.result);
  FocusResult result = std::move(judge.result);
  const auto best = static_cast<std::size_t>(std::lround((result.film_distance_mm - nearest_mm) / step));
  result.at_the_end = best == 0 || best + 1 == result.evaluations.size();
  // The part of the peak above four fifths of its height.
  std::size_t first = best, last = best;
  const auto high = [&](std::size_t i) { return result.evaluations[i].measure > 0.8 * result.measure; };
  while (first > 0 && high(first - 1)) --first;
  while (last + 1 < result.evaluations.size() && high(last + 1)) ++last;
  const double reach =
      step * (static_cast<double>(std::max({best - first, last - best, std::size_t{1}})) + 0.5);
  result.film_distance_mm =
      local_peak(result, result.film_distance_mm, reach).value_or(result.film_distance_mm);
  return result;
}

}  // namespace petzval
