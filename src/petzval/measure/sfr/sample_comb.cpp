// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/measure/sfr/sample_comb.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace petzval {

namespace {

constexpr double reach = 3;  // pixels about the edge

std::vector<double> distances_near(std::span<const EdgePoint> points) {
  std::vector<double> near;
  for (const EdgePoint& point : points)
    if (std::abs(point.distance) <= reach) near.push_back(point.distance);
  std::sort(near.begin(), near.end());
  return near;
}

}  // namespace

double widest_gap_px(std::span<const EdgePoint> points) {
  const std::vector<double> near = distances_near(points);
  double widest = 0;
  for (std::size_t i = 1; i < near.size(); ++i) widest = std::max(widest, near[i] - near[i - 1]);
  return widest;
}

double sample_comb_px(std::span<const EdgePoint> points) {
  constexpr double cell = 0.01;  // pixels: a sample's share of what it fills
  constexpr double most_filled = 0.1;
  const std::vector<double> near = distances_near(points);
  if (near.size() < 2) return 0;
  double widest = 0, filled = cell;
  for (std::size_t i = 1; i < near.size(); ++i) {
    widest = std::max(widest, near[i] - near[i - 1]);
    filled += std::min(near[i] - near[i - 1], cell);
  }
  return filled < most_filled * 2 * reach ? widest : 0;
}

void join_rows(std::vector<EdgePoint>& points) {
  constexpr double widest = 0.02;
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return points[a].distance < points[b].distance; });
  for (std::size_t first = 0, end = 0; first < order.size(); first = end) {
    double sum = 0;
    const double from = points[order[first]].distance;
    for (; end < order.size() && points[order[end]].distance < from + widest; ++end)
      sum += points[order[end]].distance;
    const double mean = sum / static_cast<double>(end - first);
    for (std::size_t i = first; i < end; ++i) points[order[i]].distance = mean;
  }
}

double alias_deviation(const EdgeSpreadModel& model, double comb_px, double frequency_cpp) {
  if (comb_px == 0 || frequency_cpp == 0) return 0;
  const double middle = 0.5 / comb_px, alias = std::max(middle, 2 * middle - frequency_cpp);
  return std::abs(model.transform(middle)) * std::pow(middle / alias, 3);
}

}  // namespace petzval
