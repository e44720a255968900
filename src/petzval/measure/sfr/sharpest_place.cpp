// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/measure/sfr/sharpest_place.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

namespace petzval {

SharpestPlace sharpest_place(std::span<const SharpnessAt> edges) {
  double best = 0;
  for (const SharpnessAt& edge : edges)
    if (std::isfinite(edge.mtf50)) best = std::max(best, edge.mtf50);
  std::vector<SharpnessAt> near;
  for (const SharpnessAt& edge : edges)
    if (std::isfinite(edge.mtf50) && edge.mtf50 > 0.5 * best) near.push_back(edge);
  constexpr std::size_t least = 4;
  if (near.size() < least)
    throw InputError(
        fmt::format("{} edges at least half as sharp as the sharpest: focus needs {} of them along the "
                    "chart",
                    near.size(), least));
  const auto [low, high] = std::ranges::minmax(near, {}, &SharpnessAt::place);
  const double middle = 0.5 * (low.place + high.place),
               half = std::max(1e-12, 0.5 * (high.place - low.place));
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  std::vector<double> weights;
  for (const SharpnessAt& edge : near) {
    // d(1/m²) = −2 dm/m³, of what is stated and of what no blur of this form follows.
    const double spread = 2 / std::pow(edge.mtf50, 3) * std::hypot(edge.deviation, 0.003 * edge.mtf50);
    weights.push_back(1 / (spread * spread));
    const double u = (edge.place - middle) / half;
    const Eigen::Vector3d row(1, u, u * u);
    normal += weights.back() * row * row.transpose();
    right += weights.back() / (edge.mtf50 * edge.mtf50) * row;
  }
  const Eigen::Matrix3d inverse = normal.inverse();
  const Eigen::Vector3d p = inverse * right;
  double scatter = 0;
  for (std::size_t i = 0; i < near.size(); ++i) {
    const double v = (near[i].place - middle) / half;
    const double rest = 1 / (near[i].mtf50 * near[i].mtf50) - p.dot(Eigen::Vector3d(1, v, v * v));
    scatter += weights[i] * rest * rest;
  }
  // Few edges may agree by chance: never less than what they state.
  scatter = std::max(1.0, scatter / static_cast<double>(near.size() - 3));
  constexpr double significant = 4;
  if (!p.allFinite() || !(p[2] > significant * std::sqrt(scatter * inverse(2, 2))))
    throw InputError(
        "sharpness does not fall to both sides along the chart: the place of focus is not among its "
        "edges");
  const double u = -p[1] / (2 * p[2]);
  if (std::abs(u) > 1)
    throw InputError(
        "sharpness is greatest beyond the edges along the chart: the place of focus is not among them");
  const Eigen::Vector3d slope(0, -1 / (2 * p[2]), -u / p[2]);
  SharpestPlace result;
  result.place = middle + half * u;
  result.deviation = half * std::sqrt(scatter * slope.dot(inverse * slope));
  result.mtf50 = 1 / std::sqrt(std::max(1e-12, p[0] + p[1] * u + p[2] * u * u));
  result.edges = near.size();
  return result;
}

std::vector<ChannelFocus> focus_along(std::span<const MeasuredEdge> edges, ChartAxis axis) {
  const bool along_x = axis == ChartAxis::x;
  std::map<std::string, std::vector<SharpnessAt>> by_channel;
  for (const MeasuredEdge& edge : edges) {
    const EdgeLine& line = edge.exact.line;
    const double along = along_x ? std::cos(line.normal_rad) : std::sin(line.normal_rad);
    if (std::abs(along) < std::cos(radians(30))) continue;
    const double scale = edge.on_chart ? edge.on_chart->per_mm : 1;
    const double x = edge.on_chart ? edge.on_chart->x_mm : line.centre_x,
                 y = edge.on_chart ? edge.on_chart->y_mm : line.centre_y;
    by_channel[edge.channel].push_back(
        {along_x ? x : y, edge.mtf50() * scale, edge.iso ? 0 : edge.exact.mtf50().deviation_cpp * scale});
  }
  if (by_channel.empty()) throw InputError("no edge runs across the axis of the tilt within 30 degrees");
  std::vector<ChannelFocus> result;
  for (const auto& [channel, sharpness] : by_channel) result.push_back({channel, sharpest_place(sharpness)});
  return result;
}

double depth_on_tilted_chart(double place_mm, double length_mm, double tilt_deg) {
  return (place_mm - 0.5 * length_mm) * std::sin(radians(tilt_deg));
}

}  // namespace petzval
