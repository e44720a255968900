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

/// With n² cos²θ' = (n + ik)² − sin²θ = (a + ib)², written out for the powers of both polarisations (Born &
/// Wolf, Principles of Optics, 7th ed. 1999, 14.2).
double conductor_reflectance(double cos_incident, double eta, double k) {
  const double cos2 = cos_incident * cos_incident, sin2 = 1 - cos2;
  const double real = eta * eta - k * k - sin2, imaginary = 2 * eta * k;
  const double size = std::sqrt(real * real + imaginary * imaginary);  // a² + b²
  const double a = std::sqrt(std::max(0.0, (size + real) / 2));
  const double across = 2 * a * cos_incident;
  const double perpendicular = (size + cos2 - across) / (size + cos2 + across);
  const double along = across * sin2, sum = size * cos2 + sin2 * sin2;
  const double parallel = perpendicular * (sum - along) / (sum + along);
  return (parallel + perpendicular) / 2;
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
