// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/measure/sfr/quiet_plane.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace petzval {

namespace {

double noise_of(const Plane& plane) {
  std::vector<double> rest;
  const std::size_t most = 100'000, pixels = plane.values.size(), step = 1 + pixels / most;
  for (std::size_t i = 1; i + 1 < pixels; i += step)
    rest.push_back(std::abs(plane.values[i] - 0.5 * (plane.values[i - 1] + plane.values[i + 1])));
  if (rest.empty()) return 0;
  const auto middle = rest.begin() + static_cast<std::ptrdiff_t>(rest.size() / 2);
  std::nth_element(rest.begin(), middle, rest.end());
  constexpr double median_of_normal = 0.6745, of_difference = 1.2247;  // √(1 + 2/4)
  return *middle / (median_of_normal * of_difference);
}

/// Every pixel the mean of itself and its neighbours, by weights 1 2 1 along both axes.
Plane smoothed(const Plane& plane) {
  Plane result = plane;
  const auto columns = static_cast<std::size_t>(plane.columns), rows = static_cast<std::size_t>(plane.rows);
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t c = 1; c + 1 < columns; ++c) {
      const double* at = plane.values.data() + r * columns + c;
      result.values[r * columns + c] = 0.25 * (at[-1] + 2 * at[0] + at[1]);
    }
  std::vector<double> above(result.values.begin(),
                            result.values.begin() + static_cast<std::ptrdiff_t>(columns));
  for (std::size_t r = 1; r + 1 < rows; ++r)
    for (std::size_t c = 0; c < columns; ++c) {
      double& here = result.values[r * columns + c];
      const double before = here;
      here = 0.25 * (above[c] + 2 * here + result.values[(r + 1) * columns + c]);
      above[c] = before;
    }
  return result;
}

}  // namespace

double noise_share(const Plane& plane) {
  const auto [low, high] = std::minmax_element(plane.values.begin(), plane.values.end());
  return noise_of(plane) / std::max(1e-300, *high - *low);
}

std::optional<Plane> quiet(const Plane& plane, double share) {
  const int passes = share < 0.005 ? 0 : share < 0.02 ? 1 : share < 0.05 ? 3 : 6;
  if (passes == 0) return std::nullopt;
  Plane result = smoothed(plane);
  for (int i = 1; i < passes; ++i) result = smoothed(result);
  return result;
}

}  // namespace petzval
