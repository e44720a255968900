// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
#include <petzval/measure/sfr/chebyshev_lanes.h>
#include <petzval/measure/sfr/smooth_about_edge.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

double chebyshev_node(int i, int count) {
  return std::cos(pi * (i + 0.5) / count);
}

/// What makes coefficients of Chebyshev polynomials of values at the nodes.
std::vector<double> cosine_transform(int count) {
  std::vector<double> cosines;
  for (int k = 0; k < count; ++k)
    for (int i = 0; i < count; ++i)
      cosines.push_back(std::cos(pi * k * (i + 0.5) / count) * (k == 0 ? 1.0 : 2.0) / count);
  return cosines;
}

const std::vector<double>& cosine_transform_of(int count) {
  static const auto tables = [] {
    std::vector<std::vector<double>> all;
    for (int n = 0; n <= SmoothAboutEdge::most_along; ++n) all.push_back(cosine_transform(n));
    return all;
  }();
  return tables[static_cast<std::size_t>(count)];
}

/// Of values `stride` apart.
void to_coefficients(double* values, int count, int stride) {
  const double* cosines = cosine_transform_of(count).data();
  double result[SmoothAboutEdge::most_along];
  for (int k = 0; k < count; ++k, cosines += count) {
    result[k] = 0;
    for (int i = 0; i < count; ++i) result[k] += cosines[i] * values[i * stride];
  }
  for (int k = 0; k < count; ++k) values[k * stride] = result[k];
}

}  // namespace

SmoothAboutEdge::SmoothAboutEdge(const std::function<double(double x, double y)>& function,
                                 const EdgeLine& line, DistanceRange range, Nodes nodes)
    : line_(line),
      cos_(std::cos(line.normal_rad)),
      sin_(std::sin(line.normal_rad)),
      middle_(0.5 * (range.low + range.high)),
      per_half_(2 / std::max(1e-9, range.high - range.low)),
      nodes_(nodes) {
  line_.bend.clear();
  coefficients_.assign(static_cast<std::size_t>(nodes.along), Across::Zero());
  for (int i = 0; i < nodes.along; ++i)
    for (int j = 0; j < nodes.across; ++j) {
      const double t = line.half_length * chebyshev_node(i, nodes.along),
                   d = middle_ + chebyshev_node(j, nodes.across) / per_half_;
      coefficients_[static_cast<std::size_t>(i)][j] =
          function(line.centre_x + d * cos_ - t * sin_, line.centre_y + d * sin_ + t * cos_);
    }
  double sum = 0;
  for (Across& across : coefficients_) to_coefficients(across.data(), nodes.across, 1);
  for (int j = 0; j < nodes.across; ++j)
    to_coefficients(coefficients_.front().data() + j, nodes.along, most_across);
  for (const Across& across : coefficients_) sum += across.abs().sum();
  const double negligible = 1e-6 * sum;
  while (!coefficients_.empty() && !(coefficients_.back().abs().maxCoeff() > negligible))
    coefficients_.pop_back();
  nodes_.along = static_cast<int>(coefficients_.size());
  const auto nearly_nothing = [&](int j) {
    return std::ranges::all_of(coefficients_,
                               [&](const Across& c) { return !(std::abs(c[j]) > negligible); });
  };
  while (nodes_.across > 2 && nearly_nothing(nodes_.across - 1)) --nodes_.across;
}

double SmoothAboutEdge::operator()(double x, double y) const {
  const double dx = x - line_.centre_x, dy = y - line_.centre_y;
  const double along = (dy * cos_ - dx * sin_) / line_.half_length,
               across = (dx * cos_ + dy * sin_ - middle_) * per_half_;
  double value = 0;
  at({&along, 1}, {&across, 1}, {&value, 1});
  return value;
}

std::vector<double> SmoothAboutEdge::at(std::span<const EdgeSample> samples) const {
  std::vector<double> along(samples.size()), across(samples.size()), values(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double dx = samples[i].x - line_.centre_x, dy = samples[i].y - line_.centre_y;
    along[i] = (dy * cos_ - dx * sin_) / line_.half_length;
    across[i] = (dx * cos_ + dy * sin_ - middle_) * per_half_;
  }
  at(along, across, values);
  return values;
}

void SmoothAboutEdge::at(std::span<const double> along, std::span<const double> across,
                         std::span<double> values) const {
  if (nodes_.along > 0)
    chebyshev_sums({coefficients_.front().data(), nodes_.along, nodes_.across, most_across}, along, across,
                   values);
}

}  // namespace petzval
