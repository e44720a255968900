// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/focus/autofocus.h>
#include <petzval/focus/brent_search.h>
#include <petzval/focus/defocus_curve.h>
#include <petzval/focus/focus_judge.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace petzval {

namespace {

/// In depths of focus. A blur disc of three pixels takes about half of the measure: flanks there are steep
/// and still near.
constexpr double flank = 2, far_flank = 2.6;
/// Nearer than this to a place that has been tried there is little to learn.
constexpr double known = 0.5;
/// How narrow a peak may be, half of what a sharp lens and the finest detail of pixels leave.
constexpr double narrowest_peak = 2;

/// The sharpest place that has been tried, and what has been tried next to it on both sides. At an end of
/// the range, itself.
struct Bracket {
  Tried low, best, high;
};

Bracket bracket_of(const FocusResult& result) {
  const auto tried = [](const FocusEvaluation& each) {
    return Tried{each.film_distance_mm, focus_cost(each.measure)};
  };
  Bracket bracket;
  for (const FocusEvaluation& each : result.evaluations)
    if (each.film_distance_mm == result.film_distance_mm) bracket.best = tried(each);
  bracket.low = bracket.high = bracket.best;
  for (const FocusEvaluation& each : result.evaluations) {
    const double x = each.film_distance_mm, best = bracket.best.x;
    if (x < best && (bracket.low.x == best || x > bracket.low.x)) bracket.low = tried(each);
    if (x > best && (bracket.high.x == best || x < bracket.high.x)) bracket.high = tried(each);
  }
  return bracket;
}

/// How far the nearest place that has been tried is.
double nearest_tried(const FocusResult& result, double x) {
  double least = std::numeric_limits<double>::infinity();
  for (const FocusEvaluation& each : result.evaluations)
    least = std::min(least, std::abs(each.film_distance_mm - x));
  return least;
}

/// Where to look next, to have the peak between two places that are no farther than `far_flank` from the
/// best; nothing when that is so. \param last_move  from the best place before to the best now; 0 if the last
/// try was no better.
std::optional<double> next_place(const FocusResult& result, const Bracket& bracket, double last_move,
                                 double depth) {
  const auto& [low, best, high] = bracket;
  const double below = best.x - low.x, above = high.x - best.x;
  if (std::max(below, above) <= far_flank * depth) return {};
  double step = 0;
  if (const auto curve = fit_curve(result, low.x, high.x, narrowest_peak * depth)) {
    step = curve->peak - best.x;
    // A peak that moved on as it was approached is farther than the curve says.
    if (step * last_move > 0) step = std::copysign(std::max(std::abs(step), 2 * std::abs(last_move)), step);
  } else if (below > 0 && above > 0) {
    BrentSearch search(low, best, high);
    step = search.next(depth).value_or(best.x) - best.x;
  }
  // Known as far as that, or on the side where a flank is there already: the other one is missing.
  const double reach = far_flank * depth;
  if (std::abs(step) < known * depth || (step > 0 ? above : below) <= reach)
    step = above > below ? flank * depth : -flank * depth;
  constexpr double inside = 0.7;
  return best.x + std::clamp(step, -inside * below, inside * above);
}

/// Brackets the peak in pictures binned by a scale (none: as they are).
void close_in(FocusJudge& judge, std::optional<std::size_t> scale, double depth, int most_evaluations) {
  double last_move = 0;
  while (judge.count() < most_evaluations) {
    const FocusResult seen = scale ? judge.seen_at(*scale) : judge.result;
    if (!(seen.measure > 0)) return;
    const std::optional<double> x = next_place(seen, bracket_of(seen), last_move, depth);
    if (!x) return;
    judge.at(*x, "close");
    last_move = (scale ? judge.seen_at(*scale) : judge.result).film_distance_mm - seen.film_distance_mm;
  }
}

/// In pixels: detail so coarse that the first places are no farther apart than a few of its own depths of
/// focus, and on the way from there to single pixels. Few or none where the range is short.
std::vector<int> scales_for(double step, double depth) {
  constexpr double depths_between_places = 8;
  const int coarsest = static_cast<int>(std::lround(std::min(step / (depths_between_places * depth), 1e4)));
  if (coarsest < 3) return {};
  if (coarsest < 12) return {coarsest};
  return {coarsest, static_cast<int>(std::lround(std::sqrt(coarsest)))};
}

/// Asks for what the last fit is to rest upon: the peak and both its flanks.
void settle(FocusJudge& judge, const FocusSearchOptions& options, double depth) {
  for (const double offset : {0.0, flank, -flank}) {
    if (judge.count() >= options.most_evaluations) return;
    const double peak = local_peak(judge.result, judge.result.film_distance_mm, far_flank * depth)
                            .value_or(judge.result.film_distance_mm);
    const double x = std::clamp(peak + offset * depth, options.nearest_mm, options.farthest_mm);
    const double room = (offset == 0 ? known : 1.0) * depth;
    if (nearest_tried(judge.result, x) > room) judge.at(x, "settle");
  }
}

}  // namespace

double FocusResult::noise_share() const {
  double sum = 0;
  for (const FocusEvaluation& each : evaluations) sum += each.noise * each.noise;
  return sum > 0 ? std::sqrt(sum / static_cast<double>(evaluations.size())) / measure : 0;
}

FocusResult find_focus(const PicturesAt& pictures_at, const std::vector<FocusZone>& zones,
                       const FocusSearchOptions& options) {
  check_film_range(options.nearest_mm, options.farthest_mm);
  constexpr int fewest_coarse = 3;
  if (options.coarse < fewest_coarse)
    throw InputError(fmt::format("a search for focus with {} coarse evaluations; {} or more would be right",
                                 options.coarse, fewest_coarse));
  if (options.most_evaluations < options.coarse)
    throw InputError(fmt::format("a search for focus in {} evaluations; {} or more would be right",
                                 options.most_evaluations, options.coarse));
  const double range = options.farthest_mm - options.nearest_mm;
  const double depth = options.depth_mm > 0 ? options.depth_mm : range / 100;
  const std::vector<int> scales = scales_for(range / (options.coarse - 1), depth);
  FocusJudge judge(pictures_at, zones, options.measure, scales);
  for (int i = 0; i < options.coarse; ++i)
    judge.at(options.nearest_mm + range * i / (options.coarse - 1), "coarse");
  require_contrast(scales.empty() ? judge.result : judge.seen_at(0));
  // Enough must be left for the peak itself.
  constexpr int for_the_peak = 4;
  for (std::size_t i = 0; i < scales.size(); ++i)
    close_in(judge, i, scales[i] * depth, options.most_evaluations - for_the_peak);
  close_in(judge, {}, depth, options.most_evaluations);
  require_contrast(judge.result);
  settle(judge, options, depth);
  FocusResult result = std::move(judge.result);
  result.film_distance_mm = std::clamp(
      local_peak(result, result.film_distance_mm, far_flank * depth).value_or(result.film_distance_mm),
      options.nearest_mm, options.farthest_mm);
  result.at_the_end = std::min(result.film_distance_mm - options.nearest_mm,
                               options.farthest_mm - result.film_distance_mm) < known * depth;
  return result;
}

}  // namespace petzval
