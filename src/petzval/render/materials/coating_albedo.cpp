// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/base/parallel.h>
#include <petzval/render/materials/coating_albedo.h>
#include <petzval/render/materials/fresnel.h>
#include <petzval/render/materials/microfacets.h>

#include <algorithm>
#include <cmath>

namespace petzval::render {

namespace {

/// Points of the quadrature over facets, each way: the albedo is smooth, and one part in a thousand is
/// enough.
constexpr int points = 24;

/// The mean of F · G over the facets that are seen.
double rough_albedo(double eta, double cos, double alpha) {
  const Microfacets facets(alpha, alpha);
  const Vector3 wo{std::sqrt(std::max(0.0, 1 - cos * cos)), 0, cos};
  double sum = 0;
  for (int i = 0; i < points; ++i)
    for (int j = 0; j < points; ++j) {
      const Vector3 m = facets.sample_seen(wo, (i + 0.5) / points, (j + 0.5) / points);
      const Vector3 wi = reflected(wo, m);
      if (wi.z <= 0) continue;
      sum +=
          dielectric_reflectance(std::abs(dot(wo, m)), eta) * facets.shown(wo, wi) * (1 + facets.lambda(wo));
    }
  return sum / (points * points);
}

}  // namespace

// Row r stands for alpha = r/(roughnesses − 1), row 0 for the smooth boundary, whose values outside() has
// exactly; column c for cos = (c + ½)/angles.
CoatingAlbedo::CoatingAlbedo(double eta) : eta_(eta) {
  parallel_for(roughnesses, [&](std::size_t r) {
    const double alpha = static_cast<double>(r) / (roughnesses - 1);
    for (int c = 0; c < angles; ++c) {
      const double cos = (c + 0.5) / angles;
      const double value = r == 0 ? dielectric_reflectance(cos, eta) : rough_albedo(eta, cos, alpha);
      table_[r][static_cast<std::size_t>(c)] = value;
      mean_[r] += 2 * cos * value / angles;
    }
  });
  mean_[0] = mean_dielectric_reflectance(eta);
}

double CoatingAlbedo::at(double cos, double row) const {
  const double column = std::clamp(cos * angles - 0.5, 0.0, angles - 1.0);
  const int c = std::min(static_cast<int>(column), angles - 2),
            r = std::min(static_cast<int>(row), roughnesses - 2);
  const double s = column - c, t = row - r;
  const auto value = [&](int i, int j) {
    return table_[static_cast<std::size_t>(r + i)][static_cast<std::size_t>(c + j)];
  };
  return (1 - t) * ((1 - s) * value(0, 0) + s * value(0, 1)) + t * ((1 - s) * value(1, 0) + s * value(1, 1));
}

double CoatingAlbedo::outside(double cos, double alpha) const {
  if (alpha < Microfacets::smooth_alpha) return dielectric_reflectance(cos, eta_);
  return at(cos, std::min(alpha, 1.0) * (roughnesses - 1));
}

double CoatingAlbedo::inside_mean(double alpha) const {
  const double row = alpha < Microfacets::smooth_alpha ? 0 : std::min(alpha, 1.0) * (roughnesses - 1);
  const int r = std::min(static_cast<int>(row), roughnesses - 2);
  const double mean =
      mean_[static_cast<std::size_t>(r)] +
      (row - r) * (mean_[static_cast<std::size_t>(r) + 1] - mean_[static_cast<std::size_t>(r)]);
  return 1 - (1 - mean) / (eta_ * eta_);
}

}  // namespace petzval::render
