// SPDX-License-Identifier: BSD-3-Clause
// How much light a smooth boundary reflects.
#pragma once

#include <algorithm>
#include <cmath>

namespace petzval::render {

/// Of unpolarised light on a boundary of relative index `eta` (far side / near side), `cos_incident` ≥ 0; 1
/// at total reflection. (Born & Wolf, Principles of Optics, 7th ed., section 1.5.)
double dielectric_reflectance(double cos_incident, double eta);

/// The same of a metal of relative index eta + i k. With n² cos²θ' = (n + ik)² − sin²θ = (a + ib)², written
/// out for the powers of both polarisations (Born & Wolf, 14.2).
template <class Real>
Real conductor_reflectance(Real cos_incident, Real eta, Real k) {
  const Real cos2 = cos_incident * cos_incident, sin2 = 1 - cos2;
  const Real real = eta * eta - k * k - sin2, imaginary = 2 * eta * k;
  const Real size = std::sqrt(real * real + imaginary * imaginary);  // a² + b²
  const Real a = std::sqrt(std::max(Real(0), (size + real) / 2));
  const Real across = 2 * a * cos_incident;
  const Real perpendicular = (size + cos2 - across) / (size + cos2 + across);
  const Real along = across * sin2, sum = size * cos2 + sin2 * sin2;
  const Real parallel = perpendicular * (sum - along) / (sum + along);
  return (parallel + perpendicular) / 2;
}

/// ∫ 2 F(cos) cos dcos: what diffuse light is reflected by.
double mean_dielectric_reflectance(double eta);

}  // namespace petzval::render
