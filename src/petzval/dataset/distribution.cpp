// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/dataset/distribution.h>
#include <petzval/numeric/random.h>

#include <algorithm>
#include <cmath>

namespace petzval {

namespace {

/// Share of a standard normal distribution below x.
double normal_share(double x) {
  return std::erfc(-x / std::sqrt(2.0)) / 2;
}

std::size_t chosen(const std::vector<double>& weights, std::size_t count, double uniform) {
  if (weights.empty())
    return std::min(static_cast<std::size_t>(uniform * static_cast<double>(count)), count - 1);
  double total = 0;
  for (const double weight : weights) total += weight;
  double below = 0;
  for (std::size_t i = 0; i + 1 < count; ++i) {
    below += weights[i];
    if (uniform * total < below) return i;
  }
  return count - 1;
}

}  // namespace

ParameterValue Distribution::at(double uniform) const {
  switch (kind) {
    case Kind::choose:
      return values[chosen(weights, values.size(), uniform)];
    case Kind::uniform:
      return from + (to - from) * uniform;
    case Kind::log_uniform:
      return from * std::pow(to / from, uniform);
    case Kind::integer:
      return from + std::min(std::floor((to - from + 1) * uniform), to - from);
    case Kind::normal:
      break;
  }
  if (to == 0) return from;
  const double low = normal_share((least - from) / to), high = normal_share((most - from) / to);
  return std::clamp(from + to * normal_quantile(low + (high - low) * uniform), least, most);
}

}  // namespace petzval
