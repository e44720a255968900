// SPDX-License-Identifier: BSD-3-Clause
#include <petzval/numeric/quadrature.h>
#include <petzval/render/materials/fresnel.h>

#include <algorithm>
#include <cmath>

namespace petzval::render {

double dielectric_reflectance(double cos_incident, double eta) {
  const double sin2_far = (1 - cos_incident * cos_incident) / (eta * eta);
  if (sin2_far >= 1) return 1;
  const double cos_far = std::sqrt(1 - sin2_far);
  const double parallel = (eta * cos_incident - cos_far) / (eta * cos_incident + cos_far);
  const double perpendicular = (cos_incident - eta * cos_far) / (cos_incident + eta * cos_far);
  return (parallel * parallel + perpendicular * perpendicular) / 2;
}

double mean_dielectric_reflectance(double eta) {
  // Towards an optically thinner side there is a kink at the critical angle: two pieces.
  const double kink = eta < 1 ? std::sqrt(1 - eta * eta) : 0;
  double sum = kink * kink;  // total reflection below it
  const QuadratureRule rule = gauss_legendre(64, 0, 1);
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    // cos = kink + (1 − kink) t², so that the root at the kink is smooth in t.
    const double t = rule.nodes[i], cos = kink + (1 - kink) * t * t;
    sum += rule.weights[i] * 2 * cos * dielectric_reflectance(cos, eta) * 2 * (1 - kink) * t;
  }
  return sum;
}

}  // namespace petzval::render
