// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/measure/sfr/corner_sharpness.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace petzval {

namespace {

/// Of the half diagonal.
constexpr double corner_reach = 0.5;
/// Deviations below which edges count alike [cycles/pixel].
constexpr double alike_cpp = 0.003;

/// 0 to 3, or nothing for an edge in the middle of the frame.
std::optional<std::size_t> corner_of(const EdgeInFrame& edge, int columns, int rows) {
  const double away = std::hypot(std::abs(edge.x_px) - 0.5 * columns, std::abs(edge.y_px) - 0.5 * rows);
  if (away > corner_reach * 0.5 * std::hypot(columns, rows)) return {};
  return static_cast<std::size_t>((edge.y_px < 0 ? 2 : 0) + (edge.x_px > 0 ? 1 : 0));
}

}  // namespace

CornerSharpness corner_sharpness(std::span<const MeasuredEdge> edges, int columns, int rows) {
  std::array<double, 4> weights{}, sums{};
  double offsets = 0;
  std::size_t colours = 0;
  for (const EdgeInFrame& edge : edges_in_frame(edges, columns, rows)) {
    const std::optional<std::size_t> corner = corner_of(edge, columns, rows);
    if (!corner) continue;
    if (edge.channel == "red" || edge.channel == "blue") {
      if (edge.lateral_offset_px) offsets += *edge.lateral_offset_px * *edge.lateral_offset_px, ++colours;
      continue;
    }
    const double weight = 1 / (alike_cpp * alike_cpp + edge.deviation_cpp * edge.deviation_cpp);
    weights[*corner] += weight;
    sums[*corner] += weight * edge.mtf50_cpp;
  }
  CornerSharpness result;
  if (colours > 0) result.colour_px = std::sqrt(offsets / static_cast<double>(colours));
  for (std::size_t i = 0; i < 4; ++i)
    result.mtf50_cpp[i] = weights[i] > 0 ? sums[i] / weights[i] : std::numeric_limits<double>::quiet_NaN();
  double largest = 0;
  result.least_cpp = std::numeric_limits<double>::infinity();
  for (const double each : result.mtf50_cpp) {
    if (std::isnan(each)) {
      result.least_cpp = result.symmetry = each;
      return result;
    }
    result.least_cpp = std::min(result.least_cpp, each);
    largest = std::max(largest, each);
  }
  result.symmetry = result.least_cpp / largest;
  return result;
}

}  // namespace petzval
