// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/error.h>
#include <petzval/focus/focus_judge.h>
#include <petzval/focus/golden_search_2006.h>

#include <algorithm>

namespace petzval {

FocusResult find_focus_2006(const PicturesAt& pictures_at, const std::vector<FocusZone>& zones,
                            const GoldenSearchOptions& options) {
  check_film_range(options.nearest_mm, options.farthest_mm);
  if (!(options.tolerance_mm > 0 && options.first_interval_mm > 0 && options.growth >= 1))
    throw InputError("golden section needs a positive tolerance and intervals that do not shrink");
  if (options.most_evaluations && *options.most_evaluations < 2)
    throw InputError("golden section takes at least 2 evaluations");
  FocusJudge judge(pictures_at, zones, options.measure);
  const auto may_ask = [&](int more) {
    return !options.most_evaluations || judge.count() + more <= *options.most_evaluations;
  };
  double width = options.first_interval_mm;
  for (double from = options.nearest_mm; from < options.farthest_mm && may_ask(2); width *= options.growth) {
    double low = from, high = std::min(from + width, options.farthest_mm);
    from = high;
    int weak = 0;
    const auto ask = [&](double x) {
      const double before = judge.result.measure, value = judge.at(x, "golden");
      weak = value < options.weak_share * before ? weak + 1 : 0;
      return value;
    };
    double a = low + golden_share * (high - low), b = high - golden_share * (high - low);
    double at_a = ask(a), at_b = ask(b);
    while (high - low > options.tolerance_mm && weak < options.weak_in_a_row && may_ask(1)) {
      if (at_a > at_b) {
        high = b, b = a, at_b = at_a;
        a = low + golden_share * (high - low);
        at_a = ask(a);
      } else {
        low = a, a = b, at_a = at_b;
        b = high - golden_share * (high - low);
        at_b = ask(b);
      }
    }
  }
  require_contrast(judge.result);
  return std::move(judge.result);
}

}  // namespace petzval
