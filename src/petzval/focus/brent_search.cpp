// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/focus/brent_search.h>
#include <petzval/focus/focus_judge.h>

#include <cmath>

namespace petzval {

BrentSearch::BrentSearch(Tried low, Tried best, Tried high)
    : low_(low.x),
      high_(high.x),
      best_(best),
      second_(low.cost < high.cost ? low : high),
      third_(low.cost < high.cost ? high : low),
      last_step_(high.x - low.x),
      step_before_(high.x - low.x) {}

std::optional<double> BrentSearch::next(double tolerance) {
  const double middle = (low_ + high_) / 2;
  if (std::abs(best_.x - middle) <= 2 * tolerance - (high_ - low_) / 2) return {};
  double step = 0;
  if (!parabola(step) || std::abs(step) >= std::abs(step_before_) / 2 || best_.x + step <= low_ ||
      best_.x + step >= high_) {
    step_before_ = best_.x < middle ? high_ - best_.x : low_ - best_.x;
    step = golden_share * step_before_;
  } else {
    step_before_ = last_step_;
    // Never at a bracket's end, nor where something has been tried.
    if (best_.x + step - low_ < 2 * tolerance || high_ - best_.x - step < 2 * tolerance)
      step = std::copysign(tolerance, middle - best_.x);
  }
  last_step_ = step;
  return best_.x + (std::abs(step) >= tolerance ? step : std::copysign(tolerance, step));
}

void BrentSearch::add(Tried tried) {
  if (tried.cost <= best_.cost) {
    (tried.x < best_.x ? high_ : low_) = best_.x;
    third_ = second_, second_ = best_, best_ = tried;
    return;
  }
  (tried.x < best_.x ? low_ : high_) = tried.x;
  if (tried.cost <= second_.cost || second_.x == best_.x) {
    third_ = second_, second_ = tried;
  } else if (tried.cost <= third_.cost || third_.x == best_.x || third_.x == second_.x) {
    third_ = tried;
  }
}

bool BrentSearch::parabola(double& step) const {
  const double r = (best_.x - second_.x) * (best_.cost - third_.cost);
  const double q = (best_.x - third_.x) * (best_.cost - second_.cost);
  const double denominator = 2 * (q - r);
  if (denominator == 0 || !std::isfinite(denominator)) return false;
  step = -((best_.x - third_.x) * q - (best_.x - second_.x) * r) / denominator;
  return std::isfinite(step);
}

}  // namespace petzval
