// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/numeric/interpolation.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval {

namespace {

void require_points(const std::vector<double>& x, const std::vector<double>& y) {
  if (x.empty() || x.size() != y.size())
    throw InputError(
        fmt::format("interpolation needs as many values as points, at least one (there are {} and {})",
                    y.size(), x.size()));
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i]))
      throw InputError(fmt::format("interpolation point {} is ({}, {}); both must be finite", i, x[i], y[i]));
    if (i > 0 && x[i] <= x[i - 1])
      throw InputError(fmt::format("interpolation points must increase: {} follows {}", x[i], x[i - 1]));
  }
}

/// Derivative at nodes[k] of the polynomial through all nodes (Berrut & Trefethen, SIAM Review 46 (2004) 501,
/// §9.3).
double lagrange_slope(std::span<const double> nodes, std::span<const double> values, std::size_t k) {
  double slope = 0;
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    if (j == k) continue;
    double weight = 1 / (nodes[k] - nodes[j]);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (i != j && i != k) weight *= (nodes[k] - nodes[i]) / (nodes[j] - nodes[i]);
    slope += weight * (values[k] - values[j]);
  }
  return slope;
}

/// The points with up to two mirror images in front, so that the first stencils are centred too.
struct Mirrored {
  std::vector<double> x, y;
  std::size_t added = 0;
};

Mirrored mirrored(const std::vector<double>& x, const std::vector<double>& y, MonotoneCubic::Start start) {
  Mirrored all;
  if (start != MonotoneCubic::Start::free) all.added = std::min<std::size_t>(2, x.size() - 1);
  for (std::size_t i = all.added; i > 0; --i) {
    all.x.push_back(2 * x[0] - x[i]);
    all.y.push_back(start == MonotoneCubic::Start::even ? y[i] : 2 * y[0] - y[i]);
  }
  all.x.insert(all.x.end(), x.begin(), x.end());
  all.y.insert(all.y.end(), y.begin(), y.end());
  return all;
}

/// What slopes may be of the lesser secant next to them.
struct SlopeLimits {
  double least, most;

  /// Up to 2 no interval has a place without a slope, whatever the slopes at its ends.
  static SlopeLimits of(MonotoneCubic::Beyond beyond) {
    return beyond == MonotoneCubic::Beyond::hold ? SlopeLimits{0, 3} : SlopeLimits{1.0 / 3, 2};
  }
  /// The slope nearest to `slope` that keeps both neighbouring intervals monotone.
  double limited(double slope, double secant_before, double secant_after) const {
    if (secant_before * secant_after <= 0) return 0;
    const double lesser = std::min(std::abs(secant_before), std::abs(secant_after));
    const double sign = secant_before > 0 ? 1 : -1;
    return sign * std::clamp(sign * slope, least * lesser, most * lesser);
  }
};

std::vector<double> monotone_slopes(const std::vector<double>& x, const std::vector<double>& y,
                                    MonotoneCubic::Start start, const SlopeLimits& limits) {
  const std::size_t count = x.size();
  const auto secant = [&](std::size_t i) { return (y[i + 1] - y[i]) / (x[i + 1] - x[i]); };
  const Mirrored all = mirrored(x, y, start);
  const std::size_t width = std::min<std::size_t>(5, all.x.size());
  std::vector<double> slopes(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t centre = i + all.added;
    const std::size_t first = std::min(centre - std::min(centre, width / 2), all.x.size() - width);
    const double slope = lagrange_slope(std::span(all.x).subspan(first, width),
                                        std::span(all.y).subspan(first, width), centre - first);
    slopes[i] = limits.limited(slope, secant(i == 0 ? 0 : i - 1), secant(std::min(i, count - 2)));
  }
  if (start == MonotoneCubic::Start::even) slopes[0] = 0;
  return slopes;
}

}  // namespace

std::size_t bracket(std::span<const double> x, double at) {
  const auto above = std::upper_bound(x.begin() + 1, x.end() - 1, at);
  return static_cast<std::size_t>(above - x.begin()) - 1;
}

MonotoneCubic::MonotoneCubic(std::vector<double> x, std::vector<double> y, Start start, Beyond beyond)
    : x_(std::move(x)), y_(std::move(y)), beyond_(beyond) {
  require_points(x_, y_);
  if (x_.size() == 1) return;
  const std::vector<double> slopes = monotone_slopes(x_, y_, start, SlopeLimits::of(beyond));
  for (std::size_t i = 0; i + 1 < x_.size(); ++i) {
    const double width = x_[i + 1] - x_[i];
    const double secant = (y_[i + 1] - y_[i]) / width;
    pieces_.push_back({y_[i], slopes[i], (3 * secant - 2 * slopes[i] - slopes[i + 1]) / width,
                       (slopes[i] + slopes[i + 1] - 2 * secant) / (width * width)});
  }
  first_slope_ = slopes.front();
  last_slope_ = slopes.back();
}

double MonotoneCubic::operator()(double x) const {
  if (x <= x_.front()) return y_.front() + (beyond_ == Beyond::linear ? first_slope_ * (x - x_.front()) : 0);
  if (x >= x_.back()) return y_.back() + (beyond_ == Beyond::linear ? last_slope_ * (x - x_.back()) : 0);
  const std::size_t i = bracket(x_, x);
  const Piece& p = pieces_[i];
  const double t = x - x_[i];
  return p.value + t * (p.slope + t * (p.quadratic + t * p.cubic));
}

double MonotoneCubic::derivative(double x) const {
  if (x < x_.front() || x_.size() == 1) return beyond_ == Beyond::linear ? first_slope_ : 0;
  if (x > x_.back()) return beyond_ == Beyond::linear ? last_slope_ : 0;
  const std::size_t i = bracket(x_, x);
  const Piece& p = pieces_[i];
  const double t = x - x_[i];
  return p.slope + t * (2 * p.quadratic + t * 3 * p.cubic);
}

double MonotoneCubic::inverse(double y) const {
  if (x_.size() == 1) return x_.front();
  const double direction = y_.back() >= y_.front() ? 1 : -1;
  const auto carried_on = [&](double x_end, double y_end, double slope) {
    return beyond_ == Beyond::linear && slope != 0 ? x_end + (y - y_end) / slope : x_end;
  };
  if (direction * (y - y_.front()) <= 0) return carried_on(x_.front(), y_.front(), first_slope_);
  if (direction * (y - y_.back()) >= 0) return carried_on(x_.back(), y_.back(), last_slope_);
  const auto above = std::upper_bound(y_.begin() + 1, y_.end() - 1, y,
                                      [&](double a, double b) { return direction * (a - b) < 0; });
  return inverse_in(static_cast<std::size_t>(above - y_.begin()) - 1, y);
}

/// Newton's method from the secant, kept inside a shrinking bracket.
double MonotoneCubic::inverse_in(std::size_t i, double y) const {
  const Piece& p = pieces_[i];
  const double width = x_[i + 1] - x_[i], rise = y_[i + 1] - y_[i];
  double low = 0, high = width, t = rise != 0 ? width * (y - y_[i]) / rise : 0;
  for (int iteration = 0; iteration < 100; ++iteration) {
    const double excess = p.value - y + t * (p.slope + t * (p.quadratic + t * p.cubic));
    if (excess == 0) break;
    (excess * rise > 0 ? high : low) = t;
    const double slope = p.slope + t * (2 * p.quadratic + t * 3 * p.cubic);
    double next = slope != 0 ? t - excess / slope : 0.5 * (low + high);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    const double step = std::abs(next - t);
    t = next;
    if (step <= std::numeric_limits<double>::epsilon() * width) break;
  }
  return x_[i] + t;
}

}  // namespace petzval
