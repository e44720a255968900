// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/imaging/field_mixture.h>
#include <petzval/numeric/interpolation.h>

#include <algorithm>

namespace petzval {

namespace {

/// Weights of three values at x[0] < x[1] < x[2] in the slope at `at` of the parabola through them.
std::array<double, 3> parabola_slope(const std::array<double, 3>& x, double at) {
  const double a = x[0], b = x[1], c = x[2];
  return {(2 * at - b - c) / ((a - b) * (a - c)), (2 * at - a - c) / ((b - a) * (b - c)),
          (2 * at - a - b) / ((c - a) * (c - b))};
}

}  // namespace

std::array<FieldShare, 4> field_shares(std::span<const double> height_mm, double at_mm) {
  std::array<FieldShare, 4> shares{};
  const std::size_t count = height_mm.size();
  if (count == 1 || at_mm <= height_mm.front() || at_mm >= height_mm.back()) {
    shares[0] = {count > 1 && at_mm >= height_mm.back() ? count - 1 : 0, 1, false};
    return shares;
  }
  const std::size_t low = bracket(height_mm, at_mm);
  const double span = height_mm[low + 1] - height_mm[low], t = (at_mm - height_mm[low]) / span;
  shares[1] = {low, (1 - t) * (1 - t) * (1 + 2 * t), false};
  shares[2] = {low + 1, t * t * (3 - 2 * t), false};

  const bool mirrored = low == 0 && height_mm.front() == 0, before = low > 0 || mirrored,
             behind = low + 2 < count;
  shares[0] = {mirrored ? 1 : low - (low > 0 ? 1 : 0), 0, mirrored};
  shares[3] = {behind ? low + 2 : low + 1, 0, false};
  const double x0 = mirrored ? -height_mm[1] : height_mm[shares[0].field], x1 = height_mm[low],
               x2 = height_mm[low + 1], x3 = height_mm[shares[3].field];
  /// Adds a slope at one end, by the parabola through the shares [first], [first + 1], [first + 2].
  const auto add_slope = [&](std::size_t first, const std::array<double, 3>& x, double end, double weight) {
    const std::array<double, 3> slope = parabola_slope(x, end);
    for (std::size_t i = 0; i < 3; ++i) shares[first + i].weight += weight * span * slope[i];
  };
  const double at_low = t * (1 - t) * (1 - t), at_high = -t * t * (1 - t);
  if (before) {
    add_slope(0, {x0, x1, x2}, x1, at_low);
    if (!behind) add_slope(0, {x0, x1, x2}, x2, at_high);
  }
  if (behind) {
    add_slope(1, {x1, x2, x3}, x2, at_high);
    if (!before) add_slope(1, {x1, x2, x3}, x1, at_low);
  }
  if (!before && !behind) {
    shares[1].weight -= at_low + at_high;
    shares[2].weight += at_low + at_high;
  }
  return shares;
}

}  // namespace petzval
