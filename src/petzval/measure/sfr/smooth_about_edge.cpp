// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/units.h>
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
    for (int n = 0; n <= SmoothAboutEdge::most_nodes; ++n) all.push_back(cosine_transform(n));
    return all;
  }();
  return tables[static_cast<std::size_t>(count)];
}

/// Of values `stride` apart.
void to_coefficients(double* values, int count, int stride) {
  const double* cosines = cosine_transform_of(count).data();
  double result[SmoothAboutEdge::most_nodes];
  for (int k = 0; k < count; ++k, cosines += count) {
    result[k] = 0;
    for (int i = 0; i < count; ++i) result[k] += cosines[i] * values[i * stride];
  }
  for (int k = 0; k < count; ++k) values[k * stride] = result[k];
}

void chebyshev_polynomials(double x, int count, double* values) {
  values[0] = 1, values[1] = x;
  for (int k = 2; k < count; ++k) values[k] = 2 * x * values[k - 1] - values[k - 2];
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
  for (int j = 0; j < nodes.across; ++j)
    for (int i = 0; i < nodes.along; ++i) {
      const double t = line.half_length * chebyshev_node(i, nodes.along),
                   d = middle_ + chebyshev_node(j, nodes.across) / per_half_;
      coefficients_.push_back(
          function(line.centre_x + d * cos_ - t * sin_, line.centre_y + d * sin_ + t * cos_));
    }
  for (int j = 0; j < nodes.across; ++j)
    to_coefficients(coefficients_.data() + j * nodes.along, nodes.along, 1);
  for (int i = 0; i < nodes.along; ++i) to_coefficients(coefficients_.data() + i, nodes.across, nodes.along);
  double sum = 0;
  for (const double c : coefficients_) sum += std::abs(c);
  constexpr double negligible = 1e-6;
  for (int j = 0; j < nodes.across; ++j) {
    int& used = used_along_[j] = nodes.along;
    while (used > 0 && !(std::abs(coefficients_[static_cast<std::size_t>(j * nodes.along + used - 1)]) >
                         negligible * sum))
      --used;
  }
}

double SmoothAboutEdge::operator()(double x, double y) const {
  const double dx = x - line_.centre_x, dy = y - line_.centre_y;
  double along[most_nodes], across[most_nodes];
  chebyshev_polynomials(std::clamp((dy * cos_ - dx * sin_) / line_.half_length, -1.0, 1.0), nodes_.along,
                        along);
  chebyshev_polynomials(std::clamp((dx * cos_ + dy * sin_ - middle_) * per_half_, -1.0, 1.0), nodes_.across,
                        across);
  double sum = 0;
  const double* c = coefficients_.data();
  for (int j = 0; j < nodes_.across; ++j, c += nodes_.along) {
    double row = 0;
    for (int i = 0; i < used_along_[j]; ++i) row += c[i] * along[i];
    sum += row * across[j];
  }
  return sum;
}

}  // namespace petzval
